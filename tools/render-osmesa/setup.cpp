#include "setup.h"

#include <algorithm>

#include "base/text.h"

namespace goniochrome {

namespace {

// The numbers of a comma-separated list, or nothing where one is none.
std::optional<std::vector<double>> numbers(const std::string& text) {
  std::vector<double> values;
  for (const std::string_view piece : split(text, ',')) {
    const auto value = parse_number(trimmed(piece));
    if (!value) return std::nullopt;
    values.push_back(*value);
  }
  return values;
}

}  // namespace

Result<PictureSize> parse_size(const std::string& text) {
  constexpr std::int64_t kMost = 16384;  // of OpenGL here
  const auto pieces = split(text, 'x');
  if (pieces.size() == 2) {
    const auto width = parse_integer(pieces[0]), height = parse_integer(pieces[1]);
    if (width && height && *width >= 1 && *height >= 1 && *width <= kMost && *height <= kMost) {
      return PictureSize{static_cast<int>(*width), static_cast<int>(*height)};
    }
  }
  return usage_error("--size is \"{}\": write WIDTHxHEIGHT in pixels, 1x1 to {}x{}", text, kMost, kMost);
}

Result<Light> parse_light(const std::string& text) {
  const auto error = [&](const char* what) { return usage_error("--light is \"{}\": {}", text, what); };
  const auto values = numbers(text);
  if (!values || values->size() < 2 || values->size() == 4 || values->size() > 6) {
    return error("write AZ,EL or X,Y,Z, and after it R,G,B if the light is not 1,1,1");
  }
  const std::vector<double>& v = *values;
  Light light;
  const bool angles = v.size() == 2 || v.size() == 5;
  light.direction = angles ? orbit_direction(v[0], v[1]) : Vec3{v[0], v[1], v[2]};
  if (!(length(light.direction) > 0)) return error("the vector to the light has no length");
  light.direction = normalized(light.direction);
  if (v.size() >= 5) light.white = {v[v.size() - 3], v[v.size() - 2], v[v.size() - 1]};
  if (std::min({light.white.x, light.white.y, light.white.z}) < 0) return error("light cannot be negative");
  return light;
}

Result<Camera> camera_of(const RenderOptions& options, const Mesh& mesh, const PictureSize& size) {
  const std::vector<double>& c = options.camera;
  if (!c.empty()) {
    if (c.size() != 6 && c.size() != 7) {
      return usage_error("--camera has {} numbers: write EX,EY,EZ,TX,TY,TZ and, if wanted, the field of view",
                         c.size());
    }
    Camera camera;
    camera.eye = {c[0], c[1], c[2]};
    camera.target = {c[3], c[4], c[5]};
    camera.fov_deg = c.size() == 7 ? c[6] : options.fov_deg;
    return camera;
  }
  const std::vector<double>& o = options.orbit;
  const double distance = o.size() == 3 ? o[2] : 1;
  if (o.size() != 2 && o.size() != 3) {
    return usage_error("--orbit has {} numbers: write AZIMUTH,ELEVATION and, if wanted, the distance", o.size());
  }
  if (std::abs(o[1]) > 90)
    return usage_error("--orbit has the elevation {}: it goes from -90 to 90 degrees", shortest(o[1]));
  if (!(distance > 0)) return usage_error("--orbit has the distance {}: it must be above 0", shortest(distance));
  return Camera::orbit(mesh, o[0], o[1], distance, options.fov_deg, static_cast<double>(size.width) / size.height);
}

Result<void> set_background(Scene& scene, const std::string& text) {
  if (text == "none") return {};
  if (text == "env") {
    if (scene.env == nullptr) return usage_error("--background env needs --env");
    scene.background = Background::kEnvironment;
    return {};
  }
  const auto color = numbers(text);
  if (!color || color->size() != 3) return usage_error("--background is \"{}\": write none, env or R,G,B", text);
  scene.background = Background::kColor;
  scene.background_color = {(*color)[0], (*color)[1], (*color)[2]};
  return {};
}

Result<std::optional<double>> parse_exposure(const std::string& text) {
  if (text == "auto") return std::optional<double>();
  const auto stops = parse_number(text);
  if (!stops || std::abs(*stops) > 64)
    return usage_error("--exposure is \"{}\": write a number of stops, or auto", text);
  return stops;
}

std::vector<std::string> aov_names(const std::vector<std::string>& options) {
  std::vector<std::string> names;
  for (const std::string& option : options) {
    for (const std::string_view name : split(option, ',')) {
      const std::string word(trimmed(name));
      if (std::find(names.begin(), names.end(), word) == names.end()) names.push_back(word);
    }
  }
  return names;
}

}  // namespace goniochrome
