#include "render/path/transport_file.h"

#include <Imath/half.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>

#include "base/angles.h"
#include "base/json.h"
#include "base/parallel.h"
#include "base/text.h"
#include "render/internal/seen.h"

namespace goniochrome::render {

namespace {

// Version 2 has the coats of the parts. In a file of version 1 no part has one.
constexpr int kVersion = 2, kVersionWithoutCoats = 1;
const char* const kColorSpace = "lin_rec2020_scene";
const char* const kProbesName = "bounced-probes";
const char* const kRemedy = "render it again with --aov transport";
const char* const kKindNames[PaintGroups::kKinds] = {"base", "gloss", "deeper"};

// "direct-diffuse", "bounced-flake-002": lobes by number, as the parts of an environment.
std::string part_name(const LobeColumns& columns, std::size_t column, bool bounced) {
  const std::string head = bounced ? "bounced-" : "direct-";
  if (column == LobeColumns::diffuse()) return head + "diffuse";
  if (column == columns.mirror()) return head + "mirror";
  return fmt::format("{}{}-{:03}", head, columns.is_gloss(column) ? "gloss" : "flake", (column - 1) / 2);
}

std::string class_name(int group) {
  return fmt::format("bounced-class-{:03}", group);
}

// The change of the gray paint of a column by rounding to halves, the 95th percentile.
double half_error(const LobeTransport& t, const image::Image& image, std::size_t column) {
  std::vector<double> errors;
  const double weight = nominal_weight(t.columns, column);
  for (std::size_t i = 0; i < t.places.size(); i += 7) {
    const float* rgb = &image.data[3 * static_cast<std::size_t>(t.places[i])];
    const color::Rgb light{rgb[0], rgb[1], rgb[2]};
    color::Rgb rounded;
    for (int c = 0; c < 3; ++c) rounded[c] = Imath::half(rgb[c]);
    color::Rgb base;
    if (t.columns.is_gloss(column))
      base = (kNominalGray / kPi / t.white_luminance) * t.light(i, LobeColumns::diffuse());
    errors.push_back(seen_difference(base + weight * light, base + weight * rounded, 1));
  }
  return percentile_95(std::move(errors));
}

Json rgb_json(const color::Rgb& c) {
  return Json::array({c.x, c.y, c.z});
}

std::string header_of(const LobeTransport& t) {
  Json header = {{"version", kVersion},
                 {"exponents", t.columns.exponents},
                 {"bounces", t.bounces},
                 {"samples", t.samples},
                 {"white_luminance", t.white_luminance},
                 {"group_of_part", t.worn.groups.of_part},
                 {"probed", t.probed},
                 {"weights", Json::array()},
                 {"probes", Json::array()}};
  for (const auto& group : t.worn.weights) {
    header["weights"].push_back(Json::array());
    for (const color::Rgb& weight : group) header["weights"].back().push_back(rgb_json(weight));
  }
  header["floor"] = t.worn.has_floor;
  header["emission"] = Json::array();
  for (const color::Rgb& radiance : t.worn.emission) header["emission"].push_back(rgb_json(radiance));
  header["brushed"] = Json::array();
  for (const paint::Anisotropy& alpha : t.worn.brushed) header["brushed"].push_back({alpha.alpha_x, alpha.alpha_y});
  header["coats"] = t.worn.coats;
  for (const BounceProbe& probe : t.probes) header["probes"].push_back(t.places[probe.point]);
  return json_text(header);
}

// A part of these channels, which stand at every point from `first` of `stride`, relative to the diffuse white.
image::ImagePart point_part(const LobeTransport& t, std::string name, const std::vector<float>& light,
                            std::size_t stride, std::size_t first, std::vector<std::string> channels) {
  const std::size_t count = channels.size();
  image::Image image{t.width, t.height, static_cast<int>(count), {}, std::move(channels)};
  image::ImagePart part{std::move(name), std::move(image), {}, image::PixelType::kHalf};
  part.image.data.assign(count * static_cast<std::size_t>(t.width) * static_cast<std::size_t>(t.height), 0.0F);
  const auto scale = static_cast<float>(1 / t.white_luminance);
  for (std::size_t i = 0; i < t.places.size(); ++i)
    for (std::size_t c = 0; c < count; ++c)
      part.image.data[count * t.places[i] + c] = scale * light[i * stride + first + c];
  return part;
}

image::ImagePart light_part(const LobeTransport& t, std::size_t column, bool bounced, TransportParts& all) {
  image::ImagePart part = point_part(t, part_name(t.columns, column, bounced), bounced ? t.bounced : t.direct,
                                     t.floats(), 3 * column, {"R", "G", "B"});
  part.attributes["goniochrome:column"] = t.columns.name(column);
  part.attributes["colorInteropID"] = kColorSpace;
  const bool fits = std::ranges::all_of(part.image.data, [](float value) { return std::abs(value) < 65504; });
  const double error = fits ? half_error(t, part.image, column) : HUGE_VAL;
  if (error > kHalfError_de00) {
    part.type = image::PixelType::kFloat;
    ++all.float_parts;
  } else {
    all.half_error_de00 = std::max(all.half_error_de00, error);
  }
  all.bytes_per_point += part.type == image::PixelType::kFloat ? 12 : 6;
  return part;
}

image::ImagePart class_part(const LobeTransport& t, int group, TransportParts& all) {
  std::vector<std::string> channels;
  for (const char* kind : kKindNames)
    for (const char* channel : {"R", "G", "B"}) channels.push_back(fmt::format("{}.{}", kind, channel));
  const std::size_t count = channels.size();
  all.bytes_per_point += 2 * static_cast<double>(count);
  return point_part(t, class_name(group), t.classes, 3 * t.worn.groups.classes(),
                    static_cast<std::size_t>(group) * count, std::move(channels));
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

}  // namespace

struct TransportReader::State {
  // Where the channels of a part go: from `first` of `stride` of each point.
  struct Target {
    int channels = 0;
    std::size_t first = 0, stride = 0;
    std::vector<float>* to = nullptr;
    bool found = false;
  };

  Result<void> begin(const image::AovFile& file) {
    file_ = &file;
    if (!targets_.empty()) return {};
    GONIO_TRY(read_header(file.transport));
    t_.width = file.image.width, t_.height = file.image.height;
    GONIO_ASSIGN(const int part_channel, file.channel("part"));
    for (int y = 0; y < t_.height; ++y) {
      for (int x = 0; x < t_.width; ++x) {
        const float part = file.image.pixel(x, y)[part_channel];
        if (part == 0) continue;
        t_.places.push_back(static_cast<std::uint32_t>(y * t_.width + x));
        t_.part.push_back(static_cast<int>(part) - 1);
        if (!(part >= 1) || static_cast<std::size_t>(part) > t_.worn.groups.of_part.size())
          return wrong(fmt::format("pixel {},{} shows part {}, and the transport knows {}", x, y, part,
                                   t_.worn.groups.of_part.size()));
      }
    }
    const std::size_t points = t_.places.size(), classes = t_.worn.groups.classes();
    t_.direct.assign(points * t_.floats(), 0), t_.bounced.assign(points * t_.floats(), 0);
    t_.classes.assign(points * classes * 3, 0);
    for (const bool bounced : {false, true})
      for (std::size_t k = 0; k < t_.columns.count() && (!bounced || t_.bounces > 0); ++k)
        targets_[part_name(t_.columns, k, bounced)] = {3, 3 * k, t_.floats(), bounced ? &t_.bounced : &t_.direct};
    for (int group = 0; group < t_.worn.groups.count && t_.bounces > 0; ++group)
      targets_[class_name(group)] = {9, 9 * static_cast<std::size_t>(group), 3 * classes, &t_.classes};
    return {};
  }

  Result<void> add(const image::ImagePart& part) {
    if (part.name == kProbesName) return read_probes(part);
    const auto target = targets_.find(part.name);
    return target != targets_.end() ? read_light(part, target->second) : Result<void>{};
  }

  Result<LobeTransport> finish() {
    for (const auto& [name, target] : targets_)
      if (!target.found) return wrong(fmt::format("it lacks the part {}", name));
    if (t_.probes.size() != probe_places_.size()) return wrong(fmt::format("it lacks the part {}", kProbesName));
    return std::move(t_);
  }

 private:
  Error wrong(const std::string& what) const {
    return input_error("{}: its transport is damaged: {}: {}", file_->path, what, kRemedy);
  }

  Result<void> read_header(const std::string& text) {
    const Json header = parse_json(text);
    if (!header.is_object()) return wrong(fmt::format("the attribute {} is no JSON object", kTransportAttribute));
    try {
      const int version = header.at("version").get<int>();
      if (version != kVersion && version != kVersionWithoutCoats)
        return input_error("{}: its transport is of version {}, and this program reads {} and {}: {}", file_->path,
                           version, kVersionWithoutCoats, kVersion, kRemedy);
      t_.columns.exponents = header.at("exponents").get<std::vector<double>>();
      t_.bounces = header.at("bounces").get<int>();
      t_.samples = header.value("samples", 1);
      t_.unit = header.at("white_luminance").get<double>();
      t_.probed = header.at("probed").get<int>();
      t_.worn.groups.of_part = header.at("group_of_part").get<std::vector<int>>();
      for (const Json& group : header.at("weights")) {
        t_.worn.weights.emplace_back();
        for (const Json& weight : group)
          t_.worn.weights.back().push_back(
              {weight.at(0).get<double>(), weight.at(1).get<double>(), weight.at(2).get<double>()});
      }
      t_.worn.has_floor = header.at("floor").get<bool>();
      for (const Json& radiance : header.at("emission"))
        t_.worn.emission.push_back(
            {radiance.at(0).get<double>(), radiance.at(1).get<double>(), radiance.at(2).get<double>()});
      for (const Json& alpha : header.at("brushed"))
        t_.worn.brushed.push_back({alpha.at(0).get<double>(), alpha.at(1).get<double>()});
      t_.worn.coats.assign(t_.worn.groups.of_part.size(), paint::kNoCoat);
      if (version == kVersion) t_.worn.coats = header.at("coats").get<std::vector<double>>();
      probe_places_ = header.at("probes").get<std::vector<std::uint32_t>>();
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

  Result<void> read_light(const image::ImagePart& part, Target& target) const {
    const image::Image& image = part.image;
    if (image.width != t_.width || image.height != t_.height || image.channels != target.channels)
      return wrong(fmt::format("its part {} has {} x {} pixels of {} channels, and the picture has {} x {} of {}",
                               part.name, image.width, image.height, image.channels, t_.width, t_.height,
                               target.channels));
    if (const std::string id = image::text_attribute(part, "colorInteropID"); !id.empty() && id != kColorSpace)
      return wrong(fmt::format("colorInteropID of its part {} is \"{}\", not \"{}\"", part.name, id, kColorSpace));
    const auto channels = static_cast<std::size_t>(target.channels);
    std::vector<std::size_t> from(channels);
    for (std::size_t c = 0; c < channels; ++c) {
      const std::string color(1, "RGB"[c % 3]), wanted = channels == 3 ? color : kKindNames[c / 3] + ("." + color);
      const auto found = std::ranges::find(image.channel_names, wanted);
      if (found == image.channel_names.end())
        return wrong(fmt::format("its part {} lacks the channel {}", part.name, wanted));
      from[c] = static_cast<std::size_t>(found - image.channel_names.begin());
    }
    std::atomic<std::size_t> worst = t_.places.size();  // a point with a value that is not finite
    parallel_for(t_.places.size(), kPointsAtOnce, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const float* pixel = &image.data[channels * t_.places[i]];
        float* to = &(*target.to)[i * target.stride + target.first];
        for (std::size_t c = 0; c < channels; ++c) {
          const float value = pixel[from[c]];
          if (!std::isfinite(value)) worst = i;
          if (value != 0) to[c] = value;  // most of a floor's light is 0, and its memory need not be touched
        }
      }
    });
    if (const std::size_t i = worst; i < t_.places.size())
      return wrong(fmt::format("its part {} has a value at pixel {},{} that is not finite", part.name,
                               t_.places[i] % static_cast<std::uint32_t>(t_.width),
                               t_.places[i] / static_cast<std::uint32_t>(t_.width)));
    target.found = true;
    return {};
  }

  Result<void> read_probes(const image::ImagePart& part) {
    const std::size_t floats =
        3 * static_cast<std::size_t>(t_.worn.groups.count) * t_.columns.count() * t_.columns.count();
    if (part.image.data.size() != 2 * floats * probe_places_.size() ||
        t_.probed < static_cast<int>(probe_places_.size()))
      return wrong(fmt::format("its part {} has {} values and not {}", kProbesName, part.image.data.size(),
                               2 * floats * probe_places_.size()));
    const float* from = part.image.data.data();
    for (const std::uint32_t place : probe_places_) {
      const auto found = std::ranges::lower_bound(t_.places, place);
      if (found == t_.places.end() || *found != place) return wrong("a probe stands beside the mesh");
      BounceProbe probe{static_cast<std::uint32_t>(found - t_.places.begin()), {}, {}};
      probe.once.assign(from, from + floats), probe.deeper.assign(from + floats, from + 2 * floats);
      from += 2 * floats;
      t_.probes.push_back(std::move(probe));
    }
    return {};
  }

  static constexpr std::size_t kPointsAtOnce = 8192;
  const image::AovFile* file_ = nullptr;
  LobeTransport t_;
  std::vector<std::uint32_t> probe_places_;
  std::map<std::string, Target> targets_;  // by the parts' names
};

TransportReader::TransportReader() : state_(std::make_unique<State>()) {}
TransportReader::~TransportReader() = default;

Result<void> TransportReader::add(const image::AovFile& file, const image::ImagePart& layer) {
  GONIO_TRY(state_->begin(file));
  return state_->add(layer);
}

Result<std::optional<LobeTransport>> TransportReader::finish(const image::AovFile& file) {
  if (file.transport.empty()) return std::optional<LobeTransport>();
  GONIO_TRY(state_->begin(file));
  GONIO_ASSIGN(LobeTransport transport, state_->finish());
  return std::optional<LobeTransport>(std::move(transport));
}

TransportParts transport_parts(const LobeTransport& t) {
  TransportParts all;
  all.header = header_of(t);
  for (const bool bounced : {false, true})
    for (std::size_t k = 0; k < t.columns.count() && (!bounced || t.bounces > 0); ++k)
      all.parts.push_back(light_part(t, k, bounced, all));
  for (int group = 0; group < t.worn.groups.count && t.bounces > 0; ++group)
    all.parts.push_back(class_part(t, group, all));
  if (!t.probes.empty()) all.parts.push_back(probe_part(t));
  return all;
}

Result<std::optional<LobeTransport>> transport_of(const image::AovFile& file) {
  TransportReader reader;
  for (const image::ImagePart& layer : file.layers) GONIO_TRY(reader.add(file, layer));
  return reader.finish(file);
}

}  // namespace goniochrome::render
