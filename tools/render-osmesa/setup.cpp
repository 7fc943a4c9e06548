#include "setup.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/angles.h"
#include "base/text.h"
#include "brdf/disc_light.h"
#include "brdf/ward.h"
#include "paints.h"
#include "render/engine.h"
#include "spectra.h"

namespace goniochrome::tool {

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

// AZ,EL[,DIST[,FOV]] or six numbers of places[,FOV].
Result<void> take_camera(Options& options) {
  std::vector<double> numbers = options.camera;
  options.camera.clear();
  if (numbers.size() == 4 || numbers.size() == 7) {
    constexpr double kLeast_deg = 1, kMost_deg = 150;
    options.fov_deg = numbers.back();
    if (!(options.fov_deg >= kLeast_deg && options.fov_deg <= kMost_deg))
      return usage_error("--camera has the field of view {}: it goes from {} to {} degrees", shortest(options.fov_deg),
                         kLeast_deg, kMost_deg);
    numbers.pop_back();
  }
  if (numbers.size() == 6) {
    options.camera = numbers;
  } else if (numbers.size() == 2 || numbers.size() == 3) {
    options.orbit = numbers;
  } else {
    return usage_error(
        "--camera has {} numbers: write AZIMUTH,ELEVATION[,DISTANCE[,FOV]], or EX,EY,EZ,TX,TY,TZ[,FOV] for where it "
        "stands and what it looks at",
        numbers.size());
  }
  return {};
}

// N[,AGAINST].
Result<void> take_check(Options& options) {
  constexpr std::int64_t kMost = 100000000;
  const auto pieces = split(options.check_text, ',');
  const auto count = parse_integer(trimmed(pieces[0]));
  const std::string against(pieces.size() > 1 ? trimmed(pieces[1]) : "auto");
  const bool known = pieces.size() == 1 || (pieces.size() == 2 && (against == "truth" || against == "model"));
  if (!count || *count < 0 || *count > kMost || !known)
    return usage_error(
        "--check is \"{}\": write how many pixels, 0 to {}, and after a comma truth or model, as in "
        "100,model",
        options.check_text, kMost);
  options.check = static_cast<int>(*count), options.check_against = against;
  return {};
}

// N or an error below 1.
Result<void> take_tilts(Options& options) {
  const auto count = parse_integer(options.tilts);
  const auto error = parse_number(options.tilts);
  if (count && *count >= 1 && *count <= brdf::kMostTilts) {
    options.most_tilts = static_cast<int>(*count), options.tilt_error = 0;
  } else if (error && *error > 0 && *error < 1) {
    options.most_tilts = brdf::kMostTilts, options.tilt_error = *error;
  } else {
    return usage_error("--tilts is \"{}\": write how many, 1 to {}, or an error between 0 and 1, as in 0.01",
                       options.tilts, brdf::kMostTilts);
  }
  return {};
}

}  // namespace

Result<Options> settled(const Options& asked) {
  Options options = asked;
  GONIO_TRY(take_camera(options));
  GONIO_TRY(take_check(options));
  GONIO_TRY(take_tilts(options));
  GONIO_ASSIGN(options.effects, render::words_of(asked.effects_text));
  if (asked.engine == kGpu) {
    const auto able = std::ranges::find_if(render::engines(), [](const auto* engine) { return engine->needs_opengl; });
    options.gpu = true, options.engine = (*able)->name;
  }
  return options;
}

// Where the surfaces come from: a mesh, or buffers that hold one view of it.
Result<void> check_surfaces(const Options& options) {
  if (options.mesh.empty() && options.gbuffer.empty())
    return usage_error("there is nothing to draw: give --mesh, or --gbuffer with the buffers of an earlier picture");
  if (options.gbuffer.empty()) return {};
  const Options usual;
  const std::pair<const char*, bool> given[] = {
      {"mesh", !options.mesh.empty()},
      {"size", options.size != usual.size},
      {"camera", !options.camera.empty() || options.orbit != usual.camera || options.fov_deg != usual.fov_deg},
      {"turntable", options.turntable > 0},
      {"texture", !options.textures.empty()}};
  for (const auto& [name, is_given] : given) {
    if (is_given)
      return usage_error("--gbuffer and --{} exclude each other: {} holds one view of surfaces without their mesh",
                         name, options.gbuffer);
  }
  std::string others;
  bool fits = true;
  for (const render::EngineInfo* engine : render::engines()) {
    if (!engine->needs_mesh) others += (others.empty() ? "" : " or ") + std::string(engine->name);
    if (engine->needs_mesh && options.engine == engine->name) fits = false;
  }
  if (fits) return {};
  return usage_error("--engine {} draws a mesh: --gbuffer is shaded by {}", options.engine, others);
}

std::optional<PictureSize> width_by_height(const std::string& text, int most) {
  const auto pieces = split(text, 'x');
  const auto width = parse_integer(pieces.front()), height = parse_integer(pieces.back());
  if (pieces.size() != 2 || !width || !height || std::min(*width, *height) < 1 || std::max(*width, *height) > most)
    return std::nullopt;
  return PictureSize{static_cast<int>(*width), static_cast<int>(*height)};
}

Result<PictureSize> parse_size(const std::string& text) {
  constexpr int kMost = 16384;  // of OpenGL here
  if (text == "auto") return PictureSize{1280, 720};
  if (const auto size = width_by_height(text, kMost)) return *size;
  return usage_error("--size is \"{}\": write WIDTHxHEIGHT in pixels, 1x1 to {}x{}, or auto", text, kMost, kMost);
}

Result<render::Light> parse_light(const std::string& text, std::optional<color::Bands>& bands) {
  bands.reset();
  const auto error = [&](const char* what) { return usage_error("--light is \"{}\": {}", text, what); };
  constexpr std::string_view kPlace = "place:";
  const bool placed = text.starts_with(kPlace);
  const std::string without = placed ? text.substr(kPlace.size()) : text;
  const std::size_t at = without.find('@');
  std::string where = without.substr(0, at);
  // A last piece that is no number names the light.
  if (const auto comma = where.rfind(','); comma != std::string::npos && std::ranges::count(where, ',') > 1) {
    const std::string word = where.substr(comma + 1);
    if (!trimmed(word).empty() && !parse_number(trimmed(word))) {
      const auto light = light_of_word(word);
      if (!light.ok())
        return Error{light.error().kind, fmt::format("--light is \"{}\": {}", text, light.error().message)};
      bands = *light;
      where.resize(comma);
    }
  }
  const auto values = numbers(where);
  if (!values || values->size() < 2 || values->size() == 4 || values->size() > 6) {
    return error(
        "write AZ,EL or X,Y,Z or place:X,Y,Z, after it R,G,B if the light is not 1,1,1, and after that @DEGREES if "
        "its diameter is not that of the sun");
  }
  const std::vector<double>& v = *values;
  render::Light light;
  const auto extent_deg = at == std::string::npos ? brdf::kSunExtent_deg : parse_number(without.substr(at + 1));
  if (!extent_deg || !(*extent_deg >= 0 && *extent_deg <= 180))
    return error("the diameter after @ goes from 0, for a point, to 180 degrees");
  light.radius_rad = 0.5 * *extent_deg * kDegree;
  const bool angles = v.size() == 2 || v.size() == 5;
  if (placed) {
    if (angles) return error("a place has three coordinates: write place:X,Y,Z");
    light.place = {{v[0], v[1], v[2]}, 1};
  }
  light.direction = angles ? render::orbit_direction(v[0], v[1]) : Vec3{v[0], v[1], v[2]};
  if (!placed && !(length(light.direction) > 0)) return error("the vector to the light has no length");
  if (!placed) light.direction = normalized(light.direction);
  if (v.size() >= 5) light.white = {v[v.size() - 3], v[v.size() - 2], v[v.size() - 1]};
  if (bands && v.size() >= 5) return error("its color is given twice: leave out one of both");
  if (bands) light.white = color_of(*bands);
  if (!bands && std::min({light.white.x, light.white.y, light.white.z}) < 0) return error("light cannot be negative");
  return light;
}

Result<void> stand_lamps(const mesh::Mesh& mesh, std::vector<render::Light>& lights) {
  for (render::Light& light : lights) {
    if (!light.place) continue;
    const Vec3 toward = light.place->position - bounding_box(mesh).middle();
    light.place->distance = length(toward);
    if (!(light.place->distance > 0))
      return usage_error("--light has a lamp in the middle of the mesh: place it outside of the mesh");
    light.direction = normalized(toward);
  }
  return {};
}

Result<render::Camera> camera_of(const Options& options, const mesh::Mesh& mesh, const PictureSize& size) {
  const std::vector<double>& c = options.camera;
  if (!c.empty()) {
    render::Camera camera;
    camera.eye = {c[0], c[1], c[2]};
    camera.target = {c[3], c[4], c[5]};
    camera.fov_deg = options.fov_deg;
    return camera;
  }
  const std::vector<double>& o = options.orbit;
  const double distance = o.size() == 3 ? o[2] : 1;
  if (std::abs(o[1]) > 90)
    return usage_error("--camera has the elevation {}: it goes from -90 to 90 degrees", shortest(o[1]));
  if (!(distance > 0)) return usage_error("--camera has the distance {}: it must be above 0", shortest(distance));
  return render::Camera::orbit(mesh, o[0], o[1], distance, options.fov_deg,
                               static_cast<double>(size.width) / size.height);
}

Result<FloorRequest> parse_floor(const std::string& text, bool usual) {
  FloorRequest request;
  std::string what = text;
  constexpr std::string_view kEye = ",eye=";
  if (const auto at = what.rfind(kEye); at != std::string::npos) {
    const auto eye = parse_number(trimmed(what.substr(at + kEye.size())));
    what.resize(at);
    if (!eye || !(*eye > 0) || what.substr(0, what.find(',')) != "shadow")
      return usage_error(
          "--floor is \"{}\": eye= goes behind shadow, with the height above the floor that the environment was seen "
          "from, as in shadow,eye=1.5",
          text);
    request.eye = *eye;
  }
  if (const auto comma = what.rfind(','); comma != std::string::npos) {
    request.height = parse_number(trimmed(what.substr(comma + 1)));
    if (!request.height)
      return usage_error("--floor is \"{}\": after the comma write the height of the floor, a number", text);
    what.resize(comma);
  }
  if (what == "auto" && !request.height) {
    request.kind = usual ? FloorRequest::Kind::kShadow : FloorRequest::Kind::kNone;
  } else if (what == "none" && !request.height) {
    request.kind = FloorRequest::Kind::kNone;
  } else if (what == "shadow") {
    request.kind = FloorRequest::Kind::kShadow;
  } else if (what.empty() || what == "none" || what == "auto") {
    return usage_error("--floor is \"{}\": write none, shadow or a paint, and after it the height of the floor", text);
  } else {
    request.kind = FloorRequest::Kind::kPaint;
    request.paint = what;
  }
  return request;
}

Result<std::vector<Emission>> parse_emissions(const std::vector<std::string>& texts) {
  std::vector<Emission> all;
  for (const std::string& text : texts) {
    const auto equals = text.rfind('=');
    const std::string light = equals == std::string::npos ? "" : text.substr(equals + 1);
    const auto rgb = equals == std::string::npos ? std::nullopt : numbers(light);
    const bool named = equals != 0 && !light.empty() && !parse_number(trimmed(light.substr(0, light.find(','))));
    if (named) {
      const auto bands = light_of_word(light);
      if (!bands.ok())
        return Error{bands.error().kind, fmt::format("--emit is \"{}\": {}", text, bands.error().message)};
      all.push_back({text.substr(0, equals), color_of(*bands), *bands});
      continue;
    }
    if (equals == 0 || !rgb || rgb->size() != 3)
      return usage_error("--emit is \"{}\": write PART=R,G,B or PART=LIGHT", text);
    if (std::min({(*rgb)[0], (*rgb)[1], (*rgb)[2]}) < 0)
      return usage_error("--emit is \"{}\": light cannot be negative", text);
    all.push_back({text.substr(0, equals), {(*rgb)[0], (*rgb)[1], (*rgb)[2]}, {}});
  }
  return all;
}

Result<void> set_ground(const FloorRequest& request, const std::optional<paint::Paint>& paint, render::Scene& scene) {
  if (request.kind == FloorRequest::Kind::kNone) return {};
  render::Ground ground = render::ground_below(*scene.mesh, request.height, request.eye);
  if (request.kind == FloorRequest::Kind::kPaint) {
    ground.kind = render::Ground::Kind::kPaint;
    ground.paint = *paint->lobes;
  } else if (scene.env == nullptr) {
    return usage_error("--floor shadow shows the ground of an environment: give --env");
  }
  scene.ground = std::move(ground);
  return {};
}

std::vector<std::string> shot_names(const Options& options) {
  const int count = std::max(options.turntable, options.light_sweep);
  if (count == 0) return {options.output};
  const std::filesystem::path path(options.output);
  std::vector<std::string> names;
  for (int i = 0; i < count; ++i) {
    const std::string name = fmt::format("{}-{:04}{}", path.stem().string(), i + 1, path.extension().string());
    names.push_back((path.parent_path() / name).string());
  }
  return names;
}

Result<std::vector<Shot>> shots_of(const Options& options, const mesh::Mesh& mesh, const PictureSize& size,
                                   const std::vector<render::Light>& lights) {
  render::Camera camera;  // of --gbuffer it is not meant
  if (options.gbuffer.empty()) {
    GONIO_ASSIGN(camera, camera_of(options, mesh, size));
  }
  if (options.turntable > 0 && options.light_sweep > 0)
    return usage_error("--turntable and --light-sweep exclude each other");
  const int count = std::max(options.turntable, options.light_sweep);
  if (count == 0) return std::vector<Shot>{{camera, lights, options.output}};
  if (options.output == "-" && options.to.empty())
    return usage_error("a sequence goes on standard output as frames: give --output a name, or --to y4m");
  if (options.light_sweep > 0 && lights.empty()) return usage_error("--light-sweep needs a --light to move");
  const std::vector<std::string> names = shot_names(options);
  std::vector<Shot> shots;
  for (int i = 0; i < count; ++i) {
    const double turn_rad = 2 * kPi * i / count, c = std::cos(turn_rad), s = std::sin(turn_rad);
    const auto turned = [&](const Vec3& v) { return Vec3{c * v.x + s * v.z, v.y, c * v.z - s * v.x}; };
    Shot shot{camera, lights, names[static_cast<std::size_t>(i)]};
    if (options.turntable > 0) shot.camera.eye = camera.target + turned(camera.eye - camera.target);
    if (options.light_sweep > 0) {
      shot.lights[0].direction = turned(lights[0].direction);
      if (lights[0].place) shot.lights[0].place->position = turned(lights[0].place->position);
    }
    shots.push_back(std::move(shot));
  }
  return shots;
}

Result<void> set_background(render::Scene& scene, const std::string& text) {
  if (text == "none") return {};
  if (text == "env") {
    if (scene.env == nullptr) return usage_error("--background env needs --env");
    scene.background = render::Background::kEnvironment;
    return {};
  }
  const auto color = numbers(text);
  if (!color || color->size() != 3) return usage_error("--background is \"{}\": write none, env or R,G,B", text);
  scene.background = render::Background::kColor;
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

}  // namespace goniochrome::tool
