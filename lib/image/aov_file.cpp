#include "image/aov_file.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/json.h"
#include "base/text.h"
#include "image/exr.h"

namespace goniochrome::image {

namespace {

// The `count` numbers that the commas in `text` part.
Result<std::vector<double>> numbers(std::string_view text, std::size_t count, const std::string& path,
                                    const char* name) {
  std::vector<double> values;
  for (const std::string_view piece : split(text, ','))
    if (const auto value = parse_number(trimmed(piece))) values.push_back(*value);
  if (values.size() != count)
    return input_error("{}: its attribute {} is \"{}\", which is not {} numbers: render the buffers again", path, name,
                       text, count);
  return values;
}

Result<void> take_rays(const std::string& text, AovFile& file) {
  if (text.empty()) return {};
  const auto pieces = split(text, ';');
  if (pieces.size() != 3)
    return input_error(
        "{}: its attribute goniochrome:rays is \"{}\", which is not three vectors: render the buffers again", file.path,
        text);
  Vec3* const rays[3] = {&file.corner, &file.right, &file.down};
  for (int i = 0; i < 3; ++i) {
    GONIO_ASSIGN(const auto v, numbers(pieces[i], 3, file.path, "goniochrome:rays"));
    *rays[i] = {v[0], v[1], v[2]};
  }
  file.has_rays = true;
  return {};
}

// A camera looks at the middle of its picture. Where a picture was cut or scaled, its rays go another way.
Result<void> check_rays(const AovFile& file) {
  constexpr double kMost_px = 0.25;
  const Vec3 middle = file.corner + 0.5 * file.image.width * file.right + 0.5 * file.image.height * file.down;
  for (const Vec3& step : {file.right, file.down})
    if (file.has_rays && std::abs(dot(middle, step)) > kMost_px * dot(step, step))
      return input_error(
          "{}: its rays are those of another size than {} x {}: it was cut or scaled; render buffers of that view, by "
          "--camera and --size",
          file.path, file.image.width, file.image.height);
  return {};
}

Result<void> take_lights(const std::string& text, AovFile& file) {
  if (text.empty()) return {};
  for (const std::string_view piece : split(text, ';')) {
    // Files of earlier versions have points, without an extent.
    const auto commas = static_cast<std::size_t>(std::ranges::count(piece, ','));
    const std::size_t count = commas == 5 ? 6 : commas == 10 ? 11 : 7;
    GONIO_ASSIGN(const auto v, numbers(piece, count, file.path, "goniochrome:lights"));
    AovLight light{{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
    if (count > 6) light.extent_deg = v[6];
    if (!(light.extent_deg >= 0 && light.extent_deg <= 180))
      return input_error("{}: its attribute goniochrome:lights has a lamp of {} deg: render the buffers again",
                         file.path, light.extent_deg);
    if (count > 7) light.is_placed = true, light.place = {v[7], v[8], v[9]}, light.distance = v[10];
    file.lights.push_back(light);
  }
  return {};
}

Result<void> take_operator(const std::string& text, AovFile& file) {
  if (text.empty()) return {};
  GONIO_ASSIGN(const auto v, numbers(text, 27, file.path, "goniochrome:operator"));
  std::size_t next = 0;
  for (auto& matrix : file.reflection.k)
    for (auto& row : matrix)
      for (double& value : row) value = v[next++];
  return {};
}

// The strings of the JSON list in an attribute.
std::vector<std::string> names_of(const Attributes& attributes, const char* name) {
  const auto text = attribute_or<std::string>(attributes, name, "");
  std::vector<std::string> names;
  for (const Json& entry : parse_json(text.empty() ? "[]" : text))
    if (entry.is_string()) names.push_back(entry.get<std::string>());
  return names;
}

}  // namespace

Result<int> AovFile::channel(const std::string& name) const {
  const auto found = std::find(image.channel_names.begin(), image.channel_names.end(), name);
  if (found != image.channel_names.end()) return static_cast<int>(found - image.channel_names.begin());
  return input_error(
      "{}: has no channel \"{}\": make the buffers by render-osmesa ... --aov normal,aspecular,lambert,mask,part -o "
      "{}{}",
      path, name, path, command.empty() ? "" : fmt::format(" (it was made by `{}`)", command));
}

Result<int> AovFile::part(const std::string& name) const {
  const auto found = std::find(parts.begin(), parts.end(), name);
  if (found != parts.end()) return static_cast<int>(found - parts.begin()) + 1;
  return usage_error("{} has no part \"{}\": its parts are {}", path, name, joined(parts, ", "));
}

namespace {

// Reads the effects from the plan in a header.
void take_plan(const std::string& plan, AovFile& file) {
  const Json effects = parse_json(plan.empty() ? "[]" : plan);
  for (const Json& effect : effects) {
    if (!effect.is_object() || !effect.contains("effect") || !effect["effect"].is_string()) continue;
    const std::string decision =
        effect.value("decision", Json()).is_string() ? effect["decision"].get<std::string>() : "";
    const auto name = effect["effect"].get<std::string>();
    if (decision == "drawn" || decision == "forced on") {
      file.drawn.push_back(name);
      const Json worth = effect.value("de00_p95", Json());
      if (name == "shadow" || name == "self" || name == "bounce" || name == "floor")
        file.drawn_by_rays += (file.drawn_by_rays.empty() ? "" : ", ") + name +
                              (worth.is_number() ? fmt::format(" (dE00 {:.1f})", worth.get<double>()) : "");
    }
    if (decision == "dropped" || decision == "forced off" || decision == "over budget") file.left_out.push_back(name);
  }
}

}  // namespace

std::string drawn_by_rays(const ImagePart& picture) {
  AovFile file;
  take_plan(attribute_or<std::string>(picture.attributes, "goniochrome:plan", ""), file);
  return file.drawn_by_rays;
}

bool is_drawn(const ImagePart& picture, const std::string& effect) {
  AovFile file;
  take_plan(attribute_or<std::string>(picture.attributes, "goniochrome:plan", ""), file);
  return std::ranges::find(file.drawn, effect) != file.drawn.end();
}

std::optional<std::vector<std::string>> left_out(const ImagePart& picture) {
  const auto plan = attribute_or<std::string>(picture.attributes, "goniochrome:plan", "");
  if (plan.empty()) return std::nullopt;
  AovFile file;
  take_plan(plan, file);
  return file.left_out;
}

namespace {

// The file by its first part, whose picture it takes.
Result<AovFile> file_of(const std::string& path, ImagePart& first) {
  const Attributes& attributes = first.attributes;
  const auto text = [&](const char* name) { return attribute_or<std::string>(attributes, name, ""); };
  AovFile file;
  file.path = path == "-" ? "standard input" : path;
  file.exposure_stops = attribute_or<float>(attributes, "goniochrome:exposure", 0);
  file.white_luminance = attribute_or<float>(attributes, "goniochrome:whiteLuminance", 1);
  if (!(file.white_luminance > 0)) file.white_luminance = 1;
  // Files without the attribute were exposed for the diffuse white.
  file.automatic_stops = attribute_or<float>(attributes, "goniochrome:automaticExposure",
                                             static_cast<float>(-std::log2(file.white_luminance)));
  file.samples = attribute_or<int>(attributes, "goniochrome:samples", 1);
  file.environment = text("goniochrome:environment");
  file.command = text("goniochrome:command");
  if (const auto light = text("goniochrome:aovLight"); !light.empty()) {
    GONIO_ASSIGN(const auto v, numbers(light, 3, file.path, "goniochrome:aovLight"));
    file.light = {v[0], v[1], v[2]};
  }
  GONIO_TRY(take_rays(text("goniochrome:rays"), file));
  if (const auto eye = text("goniochrome:eye"); !eye.empty()) {
    GONIO_ASSIGN(const auto v, numbers(eye, 3, file.path, "goniochrome:eye"));
    file.eye = Vec3{v[0], v[1], v[2]};
  }
  GONIO_TRY(take_lights(text("goniochrome:lights"), file));
  GONIO_TRY(take_operator(text("goniochrome:operator"), file));
  file.parts = names_of(attributes, "goniochrome:parts");
  file.materials = names_of(attributes, "goniochrome:materials");
  file.materials.resize(file.parts.size());
  for (const Json& number : parse_json(text("goniochrome:trim")))
    if (number.is_number_integer()) file.trim.push_back(number.get<int>());
  take_plan(text("goniochrome:plan"), file);
  file.transport = text("goniochrome:transport");
  file.image = std::move(first.image);
  GONIO_TRY(check_rays(file));
  return file;
}

// Brings the channels that are wanted from a picture of the same size.
void add_channels(Image more, const std::vector<std::string>& wanted, Image& image) {
  if (image.channels == 0 && more.channel_names == wanted) return void(image = std::move(more));
  Image all{image.width, image.height, image.channels, {}, image.channel_names};
  std::vector<int> taken;
  for (int c = 0; c < more.channels; ++c) {
    const std::string& name = more.channel_names[static_cast<std::size_t>(c)];
    if (wanted.empty() || std::ranges::find(wanted, name) != wanted.end())
      taken.push_back(c), all.channel_names.push_back(name), ++all.channels;
  }
  for (auto own = image.data.cbegin(), other = more.data.cbegin(); other != more.data.cend(); other += more.channels) {
    all.data.insert(all.data.end(), own, own + image.channels), own += image.channels;
    for (const int c : taken) all.data.push_back(other[c]);
  }
  image = std::move(all);
}

}  // namespace

Result<AovFile> read_aov_file(const std::string& path, const std::vector<std::string>& channels) {
  GONIO_ASSIGN(OpenExr exr, open_exr(path, channels));
  GONIO_ASSIGN(AovFile file, file_of(path, exr.first));
  if (file.transport.empty()) return file;
  file.layer = std::move(exr.other);
  ImagePart points;
  GONIO_ASSIGN(const bool found, file.layer(kPointsName, points));
  if (!found) return file;
  if (points.image.width != file.image.width || points.image.height != file.image.height)
    return input_error("{}: its parts picture and {} differ in size: render the buffers again", file.path, kPointsName);
  add_channels(std::move(points.image), channels, file.image);
  return file;
}

}  // namespace goniochrome::image
