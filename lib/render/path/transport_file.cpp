#include "render/path/transport_file.h"

#include <Imath/half.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <span>

#include "base/angles.h"
#include "base/json.h"
#include "base/parallel.h"
#include "base/text.h"
#include "render/internal/seen.h"

namespace goniochrome::render {

namespace {

constexpr int kVersion = 3;
const char* const kColorSpace = "lin_rec2020_scene";
const char* const kProbesName = "bounced-probes";
const char* const kColumnAttribute = "goniochrome:column";
const char* const kRemedy = "render it again with --aov transport";
const char* const kKindNames[PaintGroups::kKinds] = {"base", "gloss", "deeper"};

// "direct-diffuse", "bounced-flake-002": lobes by number, as the parts of an environment.
std::string part_name(const LobeColumns& columns, std::size_t column, bool bounced) {
  const std::string head = bounced ? "bounced-" : "direct-";
  if (column == LobeColumns::diffuse()) return head + "diffuse";
  if (column == columns.mirror()) return head + "mirror";
  return fmt::format("{}{}-{:03}", head, columns.is_gloss(column) ? "gloss" : "flake", (column - 1) / 2);
}

// The part of the group that has this class.
std::string class_name(std::size_t k) {
  return fmt::format("bounced-class-{:03}", k / PaintGroups::kKinds);
}

// The change of the gray paint of a column by rounding to halves, the 95th percentile.
double half_error(const LobeTransport& t, std::size_t column, const std::vector<float>& column_light) {
  constexpr std::size_t kStep = 7;
  constexpr double kNone = -1;
  std::vector<double> errors((t.places.size() + kStep - 1) / kStep, kNone);
  const double weight = nominal_weight(t.columns, column);
  parallel_each(errors.size(), 256, [&](std::size_t n) {
    const std::size_t i = kStep * n;
    const auto at = t.at(i, column);
    if (!at) return;
    color::Rgb light, rounded, base;
    for (int c = 0; c < 3; ++c) {
      light[c] = column_light[*at + static_cast<std::size_t>(c)] / t.white_luminance;
      rounded[c] = Imath::half(static_cast<float>(light[c]));
    }
    if (t.columns.is_gloss(column))
      base = (kNominalGray / kPi / t.white_luminance) * t.light(i, LobeColumns::diffuse());
    errors[n] = seen_difference(base + weight * light, base + weight * rounded, 1);
  });
  std::erase(errors, kNone);
  return percentile_95(std::move(errors));
}

std::string header_of(const LobeTransport& t) {
  Json header = {{"version", kVersion},
                 {"exponents", t.columns.exponents},
                 {"bounces", t.bounces},
                 {"samples", t.samples},
                 {"white_luminance", t.white_luminance},
                 {"group_of_part", t.worn.groups.of_part},
                 {"probed", t.probed},
                 {"weights", t.worn.weights},
                 {"probes", Json::array()},
                 {"floor", t.worn.has_floor},
                 {"emission", t.worn.emission},
                 {"brushed", Json::array()}};
  for (const paint::Anisotropy& alpha : t.worn.brushed) header["brushed"].push_back({alpha.alpha_x, alpha.alpha_y});
  header["coats"] = t.worn.coats;
  for (const BounceProbe& probe : t.probes) header["probes"].push_back(t.places[probe.point]);
  return json_text(header);
}

// A part of the rectangle around these points with their light, R G B each, relative to the diffuse white.
image::ImagePart point_part(const LobeTransport& t, std::string name, const std::vector<std::uint32_t>& points,
                            std::span<const std::vector<float>> light, std::vector<std::string> channels) {
  const std::size_t count = channels.size();
  image::ImagePart part{std::move(name), {1, 1, static_cast<int>(count), {}, std::move(channels)}, {}};
  image::Image& image = part.image;
  for (const std::uint32_t point : points) {
    const auto [x, y] = t.pixel(point);
    if (point == points.front()) part.left = x, part.top = y;
    const int right = std::max(x, part.left + image.width - 1);
    part.left = std::min(x, part.left), image.width = right - part.left + 1, image.height = y - part.top + 1;
  }
  image.data.assign(count * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height), 0.0F);
  const auto scale = static_cast<float>(1 / t.white_luminance);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto [x, y] = t.pixel(points[i]);
    float* pixel = image.pixel(x - part.left, y - part.top);
    for (std::size_t c = 0; c < count; ++c) pixel[c] = scale * light[c / 3][3 * i + c % 3];
  }
  return part;
}

image::ImagePart light_part(const LobeTransport& t, std::size_t column, bool bounced, TransportParts& all) {
  const std::vector<float>& light = (bounced ? t.bounced : t.direct)[column];
  image::ImagePart part =
      point_part(t, part_name(t.columns, column, bounced), t.points_of(column), {&light, 1}, {"R", "G", "B"});
  part.attributes[kColumnAttribute] = t.columns.name(column);
  part.attributes["colorInteropID"] = kColorSpace;
  const bool fits = std::ranges::all_of(part.image.data, [](float value) { return std::abs(value) < 65504; });
  const double error = fits ? half_error(t, column, light) : HUGE_VAL;
  if (error > kHalfError_de00) {
    part.type = image::PixelType::kFloat;
    ++all.float_parts;
  } else {
    all.half_error_de00 = std::max(all.half_error_de00, error);
  }
  all.bytes_per_point += (part.type == image::PixelType::kFloat ? 4.0 : 2.0) * static_cast<double>(light.size());
  return part;
}

image::ImagePart class_part(const LobeTransport& t, std::size_t k, TransportParts& all) {
  std::vector<std::string> channels;
  for (const char* kind : kKindNames)
    for (const char* channel : {"R", "G", "B"}) channels.push_back(fmt::format("{}.{}", kind, channel));
  const std::vector<std::uint32_t> points = t.points_of(t.columns.mirror());
  all.bytes_per_point += 2 * static_cast<double>(channels.size() * points.size());
  image::ImagePart part =
      point_part(t, class_name(k), points, {&t.classes[k], PaintGroups::kKinds}, std::move(channels));
  part.attributes[kColumnAttribute] = "class";
  return part;
}

// Probe by probe a row: once, then deeper.
image::ImagePart probe_part(const LobeTransport& t) {
  const std::size_t floats = t.probes.front().once.size();
  image::ImagePart part{kProbesName,
                        {static_cast<int>(2 * floats), static_cast<int>(t.probes.size()), 1, {}, {"Y"}},
                        {},
                        image::PixelType::kFloat};
  for (const BounceProbe& probe : t.probes) {
    part.image.data.insert(part.image.data.end(), probe.once.begin(), probe.once.end());
    part.image.data.insert(part.image.data.end(), probe.deeper.begin(), probe.deeper.end());
  }
  for (float& value : part.image.data) value = static_cast<float>(value / t.white_luminance);
  return part;
}

// Reads into the transport that it is given.
class Reading {
 public:
  Reading(const image::AovFile& file, LobeTransport& t) : file_(file), t_(t) {}

  Result<void> points() {
    GONIO_TRY(read_header(file_.transport));
    t_.width = file_.image.width, t_.height = file_.image.height;
    GONIO_ASSIGN(const int part_channel, file_.channel("part"));
    const std::size_t pixels = static_cast<std::size_t>(t_.width) * static_cast<std::size_t>(t_.height);
    t_.places.reserve(pixels), t_.part.reserve(pixels);
    for (int y = 0; y < t_.height; ++y) {
      for (int x = 0; x < t_.width; ++x) {
        const float part = file_.image.pixel(x, y)[part_channel];
        if (part == 0) continue;
        t_.places.push_back(static_cast<std::uint32_t>(y * t_.width + x));
        t_.part.push_back(static_cast<int>(part) - 1);
        if (!(part >= 1) || static_cast<std::size_t>(part) > t_.worn.groups.of_part.size())
          return wrong(fmt::format("pixel {},{} shows part {}, and the transport knows {}", x, y, part,
                                   t_.worn.groups.of_part.size()));
      }
    }
    for (BounceProbe& probe : t_.probes) {
      const auto found = std::ranges::lower_bound(t_.places, probe.point);
      if (found == t_.places.end() || *found != probe.point) return wrong("a probe stands beside the mesh");
      probe.point = static_cast<std::uint32_t>(found - t_.places.begin());
    }
    return {};
  }

  Result<void> light(const std::vector<bool>& wanted) {
    t_.make_room(wanted);
    const std::vector<std::uint32_t> all = t_.points_of(LobeColumns::diffuse()),
                                     some = t_.points_of(t_.columns.mirror());
    for (const bool bounced : {false, true})
      for (std::size_t k = 0; k < t_.columns.count(); ++k) {
        std::vector<float>& to = (bounced ? t_.bounced : t_.direct)[k];
        if (to.empty()) continue;
        GONIO_TRY(read_light(part_name(t_.columns, k, bounced), k == LobeColumns::diffuse() ? all : some, {&to, 1}));
      }
    for (std::size_t k = 0; k < t_.classes.size(); k += PaintGroups::kKinds)
      GONIO_TRY(read_light(class_name(k), some, {&t_.classes[k], PaintGroups::kKinds}));
    return t_.probes.empty() ? Result<void>{} : read_probes();
  }

 private:
  Error wrong(const std::string& what) const {
    return input_error("{}: its transport is damaged: {}: {}", file_.path, what, kRemedy);
  }

  Result<void> read_header(const std::string& text) {
    const Json header = parse_json(text);
    if (!header.is_object()) return wrong(fmt::format("the attribute {} is no JSON object", kTransportAttribute));
    try {
      const int version = header.at("version").get<int>();
      if (version != kVersion)
        return input_error("{}: its transport is of version {}, and this program reads {}: {}", file_.path, version,
                           kVersion, kRemedy);
      header.at("exponents").get_to(t_.columns.exponents);
      header.at("bounces").get_to(t_.bounces);
      header.at("samples").get_to(t_.samples);
      header.at("white_luminance").get_to(t_.unit);
      header.at("probed").get_to(t_.probed);
      header.at("group_of_part").get_to(t_.worn.groups.of_part);
      header.at("weights").get_to(t_.worn.weights);
      header.at("floor").get_to(t_.worn.has_floor);
      header.at("emission").get_to(t_.worn.emission);
      for (const Json& alpha : header.at("brushed"))
        t_.worn.brushed.push_back({alpha.at(0).get<double>(), alpha.at(1).get<double>()});
      header.at("coats").get_to(t_.worn.coats);
      for (const Json& place : header.at("probes")) t_.probes.push_back({place.get<std::uint32_t>(), {}, {}});
    } catch (const std::exception& e) {
      return wrong(fmt::format("the attribute {}: {}", kTransportAttribute, e.what()));
    }
    t_.worn.groups.count = static_cast<int>(t_.worn.weights.size());
    const std::vector<double>& exponents = t_.columns.exponents;
    if (exponents.size() > kMostTracedLobes || !std::ranges::is_sorted(exponents) || t_.bounces < 0 || !(t_.unit > 0) ||
        (t_.samples != 1 && t_.samples != 4 && t_.samples != 16))
      return wrong("its exponents, bounces, samples or white are not what a transport has");
    if (t_.worn.groups.of_part.size() != t_.worn.brushed.size() + (t_.worn.has_floor ? 1 : 0) ||
        t_.worn.emission.size() != t_.worn.brushed.size() || t_.worn.coats.size() != t_.worn.groups.of_part.size())
      return wrong("its parts, their emission, their coats and their brushing differ in number");
    for (const auto& group : t_.worn.weights)
      if (group.size() != t_.columns.count())
        return wrong(fmt::format("a paint has {} weights for {} columns", group.size(), t_.columns.count()));
    for (const int group : t_.worn.groups.of_part)
      if (group < 0 || group >= t_.worn.groups.count) return wrong(fmt::format("there is no group {}", group));
    t_.worn.floor_is_projected = t_.worn.has_floor && is_projected(t_.worn.groups.of_part.back());
    return {};
  }

  // True if a group wears a floor that shows the environment; a paint reflects less than its weights.
  bool is_projected(int group) const {
    std::vector<color::Rgb> laid(t_.columns.count());
    laid[LobeColumns::diffuse()] = {1, 1, 1};
    return t_.worn.weights[static_cast<std::size_t>(group)] == laid;
  }

  Result<void> read_part(const std::string& name) {
    GONIO_ASSIGN(const bool found, file_.layer ? file_.layer(name, part_) : Result<bool>(false));
    return found ? Result<void>{} : wrong(fmt::format("it lacks the part {}", name));
  }

  // Reads the light of these points, R G B each.
  Result<void> read_light(const std::string& name, const std::vector<std::uint32_t>& points,
                          std::span<std::vector<float>> to) {
    const std::size_t channels = 3 * to.size();
    GONIO_TRY(read_part(name));
    const image::Image& image = part_.image;
    const int left = part_.left, top = part_.top, right = left + image.width, bottom = top + image.height;
    if (left < 0 || top < 0 || right > t_.width || bottom > t_.height || image.channels != static_cast<int>(channels))
      return wrong(
          fmt::format("its part {} has {} x {} pixels from {},{} on, of {} channels, and the picture has {} x {} "
                      "of {}",
                      name, image.width, image.height, left, top, image.channels, t_.width, t_.height, channels));
    if (const std::string id = image::text_attribute(part_, "colorInteropID"); !id.empty() && id != kColorSpace)
      return wrong(fmt::format("colorInteropID of its part {} is \"{}\", not \"{}\"", name, id, kColorSpace));
    std::vector<std::size_t> from(channels);
    for (std::size_t c = 0; c < channels; ++c) {
      const std::string color(1, "RGB"[c % 3]), wanted = channels == 3 ? color : kKindNames[c / 3] + ("." + color);
      const auto found = std::ranges::find(image.channel_names, wanted);
      if (found == image.channel_names.end())
        return wrong(fmt::format("its part {} lacks the channel {}", name, wanted));
      from[c] = static_cast<std::size_t>(found - image.channel_names.begin());
    }
    std::atomic<std::size_t> worst = points.size();  // a point without a finite value
    parallel_each(points.size(), kPointsAtOnce, [&](std::size_t i) {
      const auto [x, y] = t_.pixel(points[i]);
      if (x < left || x >= right || y < top || y >= bottom) {
        worst = i;
        return;
      }
      const float* values = image.pixel(x - left, y - top);
      for (std::size_t c = 0; c < channels; ++c) {
        to[c / 3][3 * i + c % 3] = values[from[c]];
        if (!std::isfinite(values[from[c]])) worst = i;
      }
    });
    if (const std::size_t i = worst; i < points.size()) {
      const auto [x, y] = t_.pixel(points[i]);
      return wrong(fmt::format("its part {} has no finite value at pixel {},{}", name, x, y));
    }
    return {};
  }

  Result<void> read_probes() {
    GONIO_TRY(read_part(kProbesName));
    const std::size_t floats =
        3 * static_cast<std::size_t>(t_.worn.groups.count) * t_.columns.count() * t_.columns.count();
    if (part_.image.data.size() != 2 * floats * t_.probes.size() || t_.probed < static_cast<int>(t_.probes.size()))
      return wrong(fmt::format("its part {} has {} values and not {}", kProbesName, part_.image.data.size(),
                               2 * floats * t_.probes.size()));
    const float* from = part_.image.data.data();
    for (BounceProbe& probe : t_.probes) {
      probe.once.assign(from, from + floats), probe.deeper.assign(from + floats, from + 2 * floats);
      from += 2 * floats;
    }
    return {};
  }

  static constexpr std::size_t kPointsAtOnce = 8192;
  const image::AovFile& file_;
  LobeTransport& t_;
  image::ImagePart part_;  // read last
};

}  // namespace

TransportParts transport_parts(const LobeTransport& t) {
  TransportParts all;
  all.header = header_of(t);
  for (const bool bounced : {false, true})
    for (std::size_t k = 0; k < t.columns.count() && (!bounced || t.bounces > 0); ++k)
      all.parts.push_back(light_part(t, k, bounced, all));
  for (std::size_t k = 0; k < t.classes.size(); k += PaintGroups::kKinds) all.parts.push_back(class_part(t, k, all));
  all.bytes_per_point /= std::max<double>(1, static_cast<double>(t.places.size()));
  if (!t.probes.empty()) all.parts.push_back(probe_part(t));
  return all;
}

Result<std::optional<LobeTransport>> transport_points(const image::AovFile& file) {
  if (file.transport.empty()) return std::optional<LobeTransport>();
  LobeTransport t;
  GONIO_TRY(Reading(file, t).points());
  return std::optional(std::move(t));
}

Result<void> read_light(const image::AovFile& file, const std::vector<bool>& wanted, LobeTransport& t) {
  return Reading(file, t).light(wanted);
}

Result<std::optional<LobeTransport>> transport_of(const image::AovFile& file) {
  GONIO_ASSIGN(auto transport, transport_points(file));
  if (transport) GONIO_TRY(read_light(file, {}, *transport));
  return transport;
}

}  // namespace goniochrome::render
