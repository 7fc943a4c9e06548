#include "panels/seam.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/text.h"
#include "envmap/cube_map.h"
#include "fit/paint_fit.h"

namespace goniochrome::panels {

namespace {

constexpr double kEdgeOn = 0.02;  // cosine; a panel nearer to edge on is not seen

bool sees_both(const mesh::SeamPoint& p, const Vec3& view) {
  return dot(p.normal_a, view) > kEdgeOn && dot(p.normal_b, view) > kEdgeOn;
}

bool is_glare(const Vec3& light, const Vec3& view, const Vec3& normal) {
  return paint::aspecular_angle_rad(light, view, normal) < kIndexGlare_deg * kDegree - 1e-9;
}

Result<std::vector<Vec3>> directions_of(const char* option, const std::vector<std::string>& texts) {
  std::vector<Vec3> directions;
  for (const std::string& text : texts) {
    const auto words = split(text, ',');
    const auto azimuth = parse_number(trimmed(words[0]));
    const auto elevation = words.size() == 2 ? parse_number(trimmed(words[1])) : std::nullopt;
    if (!azimuth || !elevation || std::abs(*elevation) > 90)
      return usage_error("{} is \"{}\": write AZIMUTH,ELEVATION in degrees, elevation -90 to 90", option, text);
    directions.push_back(render::orbit_direction(*azimuth, *elevation));
  }
  return directions;
}

}  // namespace

// In the frame of the first panel at a place, x points away from the light in the plane of incidence. For a seam across
// that plane x is `across` where the light comes from the first panel's side, and its opposite for the second's.
std::vector<SeamView> views_at_seam(const mesh::Seam& seam, const GeometryList& geometries, double seam_deg) {
  std::vector<SeamView> views;
  const double turn = (90 - seam_deg) * kDegree;
  for (std::size_t i = 0; i < seam.points.size(); ++i) {
    const mesh::SeamPoint& p = seam.points[i];
    for (const double side : {1.0, -1.0}) {
      const Vec3 across = side * p.across;
      const Vec3 x = std::cos(turn) * across - std::sin(turn) * cross(p.normal_a, across), y = cross(p.normal_a, x);
      const auto to_world = [&](const Vec3& v) { return v.x * x + v.y * y + v.z * p.normal_a; };
      for (std::size_t g = 0; g < geometries.pairs.size(); ++g) {
        const paint::DirectionPair pair = directions(geometries.pairs[g]);
        const Vec3 view = to_world(pair.view);
        if (sees_both(p, view)) views.push_back({i, to_world(pair.light), view, geometries.weights[g]});
      }
    }
  }
  return views;
}

std::vector<SeamView> views_in_world(const mesh::Seam& seam, const std::vector<Vec3>& lights,
                                     const std::vector<Vec3>& viewers) {
  std::vector<SeamView> views;
  for (std::size_t i = 0; i < seam.points.size(); ++i) {
    const mesh::SeamPoint& p = seam.points[i];
    for (const Vec3& view : viewers) {
      if (!sees_both(p, view)) continue;
      if (lights.empty()) views.push_back({i, std::nullopt, view, 1});
      for (const Vec3& light : lights) {
        const bool dark = dot(light, p.normal_a) <= 0 && dot(light, p.normal_b) <= 0;
        if (!dark && !is_glare(light, view, p.normal_a) && !is_glare(light, view, p.normal_b))
          views.push_back({i, light, view, 1});
      }
    }
  }
  return views;
}

std::vector<std::size_t> spread_places(std::size_t count, std::size_t most) {
  constexpr double kGolden = 0.6180339887498949;
  std::vector<std::size_t> places(std::min(count, most));
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double part = std::fmod(static_cast<double>(i) * kGolden, 1.0);
    places[i] = count <= most ? i : static_cast<std::size_t>(part * static_cast<double>(count));
  }
  return places;
}

PanelView panel_view(const mesh::Seam& seam, const SeamView& view) {
  const mesh::SeamPoint& p = seam.points[view.point];
  const auto aspecular = [&](const Vec3& n) { return paint::aspecular_angle_rad(*view.light, view.view, n) / kDegree; };
  const auto cosine = [&](const Vec3& n) { return std::max(0.0, dot(n, *view.light)); };
  const auto cos_view = [&](const Vec3& n) { return std::max(0.0, dot(n, view.view)); };
  return {aspecular(p.normal_a), cosine(p.normal_a),   aspecular(p.normal_b), cosine(p.normal_b),
          view.weight,           cos_view(p.normal_a), cos_view(p.normal_b)};
}

std::vector<SeamDifference> by_place(const mesh::Seam& seam, const std::vector<SeamView>& views,
                                     const std::vector<double>& de) {
  std::vector<SeamDifference> places(seam.points.size());
  std::vector<double> weight(seam.points.size(), 0.0);
  for (std::size_t i = 0; i < views.size(); ++i) {
    SeamDifference& place = places[views[i].point];
    place.max = std::max(place.max, de[i]);
    place.rms += views[i].weight * de[i] * de[i];
    weight[views[i].point] += views[i].weight;
    ++place.views;
  }
  for (std::size_t p = 0; p < places.size(); ++p) {
    places[p].rms = std::sqrt(places[p].rms / weight[p]);  // NaN without views
    if (places[p].views == 0) places[p].max = std::numeric_limits<double>::quiet_NaN();
  }
  return places;
}

fit::PaintFitter appearance_fitter(const std::vector<double>& exponents) {
  fit::FitOptions options;
  options.method = fit::FitMethod::kL2;
  options.target = paint::TargetCurve::Kind::kCurve;
  return {formats::Basis{"appearance", exponents}, options};
}

Result<paint::LobeFit> appearance_lobes(const fit::PaintFitter& fitter, const paint::Appearance& appearance,
                                        const color::ViewingCondition& condition, double coat_index) {
  paint::Paint paint;
  paint.coat_index = coat_index;
  paint.measurement = paint::Measurement{condition, "", paint::rows_of(appearance)};
  paint.appearance = appearance;
  GONIO_ASSIGN(fit::PaintFit fit, fitter.fit(paint));
  return std::move(fit.lobes);
}

Result<EnvironmentPanels> EnvironmentPanels::make(const envmap::PrefilteredEnvironment& env,
                                                  const color::ViewingCondition& condition, double coat_index) {
  EnvironmentPanels panels;
  panels.coat_index_ = coat_index;
  for (const envmap::PrefilteredLobe& lobe : env.lobes) panels.columns_.exponents.push_back(lobe.exponent);
  if (panels.exponents().empty())
    return input_error("the environment has no lobes: make it by prefilter-envmap with a basis or --exponents");
  double most = 0;
  const envmap::CubeMap& diffuse = env.diffuse.map;
  for (std::size_t i = 0; i < diffuse.texels.size(); i += 3)
    most = std::max(most, color::luminance(vec3(&diffuse.texels[i])));
  if (!(most > 0)) return input_error("the environment is black: there is no white to compare with");
  panels.luminance_ = most;
  render::Scene scene;
  scene.env = &env;
  GONIO_ASSIGN(panels.open_,
               render::OpenLight::create(scene, panels.columns_, {coat_index}, {.horizon = false, .mirror = false}));
  panels.condition_ = condition;
  GONIO_ASSIGN(panels.white_, color::white_point(condition));
  panels.fitter_ = std::make_shared<const fit::PaintFitter>(appearance_fitter(panels.exponents()));
  return panels;
}

EnvironmentPanels::Light EnvironmentPanels::light(const Vec3& normal, const Vec3& view) const {
  Light light(columns_.count());
  open_->at(normal, view, 0, light.data());
  return light;
}

Result<paint::LobeFit> EnvironmentPanels::lobes(const paint::Appearance& appearance) const {
  return appearance_lobes(*fitter_, appearance, condition_, coat_index_);
}

color::Lab EnvironmentPanels::color(const paint::LobeFit& paint, const Light& light) const {
  color::Rgb radiance = paint.diffuse * light[render::LobeColumns::diffuse()];
  for (const paint::Lobe& lobe : paint.lobes) {
    const auto at = std::ranges::find(exponents(), lobe.exponent);
    if (at == exponents().end()) continue;
    const auto number = static_cast<std::size_t>(at - exponents().begin());
    radiance += lobe.directional_diffuse * light[render::LobeColumns::flake(number)];
  }
  return color::lab_from_rgb((1 / luminance_) * radiance, white_);
}

PanelColors seam_colors(const EnvironmentPanels& panels, const mesh::Seam& seam, const std::vector<SeamView>& views,
                        SeamSide side) {
  std::vector<EnvironmentPanels::Light> lights;
  for (const SeamView& view : views) {
    const mesh::SeamPoint& p = seam.points[view.point];
    lights.push_back(panels.light(side == SeamSide::kA ? p.normal_a : p.normal_b, view.view));
  }
  return seam_colors(panels, std::move(lights));
}

PanelColors seam_colors(const EnvironmentPanels& panels, std::vector<EnvironmentPanels::Light> lights) {
  return [&panels, lights = std::move(lights)](const paint::Appearance& paint) -> Result<std::vector<color::Lab>> {
    GONIO_ASSIGN(const paint::LobeFit fit, panels.lobes(paint));
    std::vector<color::Lab> colors;
    for (const auto& light : lights) colors.push_back(panels.color(fit, light));
    return colors;
  };
}

bool SeamTexts::names_anything_but_mesh() const {
  return !seam.empty() || !environment.empty() || open || !lights_from.empty() || !views_from.empty();
}

Result<SeamWorld> seam_world(const SeamTexts& texts) {
  SeamWorld world;
  const auto parts = split(texts.seam, ',');
  if (parts.size() != 2 || trimmed(parts[0]).empty() || trimmed(parts[1]).empty())
    return usage_error("--seam is \"{}\": name two parts of the mesh, A,B", texts.seam);
  world.part_a = trimmed(parts[0]), world.part_b = trimmed(parts[1]);
  world.seam.unit_m = texts.unit == "m"    ? 1
                      : texts.unit == "in" ? 0.0254
                      : texts.unit == "cm" ? 1e-2
                      : texts.unit == "mm" ? 1e-3
                                           : 0;
  world.seam.max_gap_mm = texts.max_gap_mm;
  GONIO_ASSIGN(world.lights, directions_of("--light-from", texts.lights_from));
  GONIO_ASSIGN(world.viewers, directions_of("--view-from", texts.views_from));
  if (!world.lights.empty() && !texts.environment.empty())
    return usage_error("--light-from and --environment exclude each other");
  if (texts.open && texts.environment.empty())
    return usage_error("--open is about the light of an environment: give --environment");
  world.in_world = !world.lights.empty() || !texts.environment.empty();
  if (world.in_world && world.viewers.empty())
    return usage_error("lights in the world want viewers there: give --view-from AZ,EL");
  if (!world.in_world && !world.viewers.empty()) return usage_error("--view-from wants --light-from or --environment");
  return world;
}

Result<SeamStage> seam_stage(const SeamTexts& texts, const SeamWorld& world, const GeometryList& geometries,
                             double seam_deg) {
  SeamStage stage;
  GONIO_ASSIGN(stage.mesh, mesh::read_mesh(texts.mesh));
  auto seam = mesh::seam_between(stage.mesh, world.part_a, world.part_b, world.seam);
  if (!seam.ok()) return input_error("{}: {}", texts.mesh, seam.error().message);
  stage.seam = std::move(*seam);
  stage.views = world.in_world ? views_in_world(stage.seam, world.lights, world.viewers)
                               : views_at_seam(stage.seam, geometries, seam_deg);
  if (stage.views.empty())
    return input_error("{}: no viewer sees both panels in any light: change --views or --view-from", texts.mesh);
  if (texts.environment.empty()) return stage;
  GONIO_ASSIGN(stage.env, envmap::read_env(texts.environment));
  // An environment that cannot be used is refused here once, by the name of its file, and not for every paint.
  if (auto panels = EnvironmentPanels::make(stage.env, {}); !panels.ok())
    return input_error("{}: {}", texts.environment, panels.error().message);
  return stage;
}

std::string seam_light_text(const SeamTexts& texts, const SeamWorld& world, const GeometryList& geometries) {
  const bool traced = world.in_world && !texts.environment.empty() && !texts.open;
  const char* const left_out = traced ? "left out: gloss; traced: what the mesh takes from the light and sends back\n"
                                      : "left out: gloss, and shadows and reflections of the mesh on itself\n";
  if (!world.in_world)
    return fmt::format("{} pairs of light and viewer at every place, the light from both sides of the seam\n{}",
                       geometries.pairs.size(), left_out);
  return fmt::format(
      "{} viewers in the world, {}\n{}", world.viewers.size(),
      texts.environment.empty() ? fmt::format("{} lights", world.lights.size()) : "light of " + texts.environment,
      left_out);
}

// The sphere about the middle of the seam's box that holds all places just fits between the borders that are nearer.
render::Camera seam_camera_from(const mesh::Seam& seam, const Vec3& direction, double aspect, double fov_deg,
                                double margin) {
  mesh::Box box = mesh::kEmptyBox;
  for (const mesh::SeamPoint& p : seam.points) box.add(p.a), box.add(p.b);
  const Vec3 middle = box.middle();
  double radius = 0;
  for (const mesh::SeamPoint& p : seam.points) radius = std::max(radius, length(p.a - middle));
  const double half = fov_deg / 2 * kDegree;
  const double narrow = aspect < 1 ? std::atan(std::tan(half) * aspect) : half;
  render::Camera camera;
  camera.target = middle;
  camera.eye = middle + (margin * radius / std::sin(narrow)) * direction;
  camera.fov_deg = fov_deg;
  return camera;
}

render::Camera seam_camera(const mesh::Seam& seam, double aspect, double fov_deg, double margin) {
  Vec3 outward;
  for (const mesh::SeamPoint& p : seam.points) outward += p.normal_a + p.normal_b;
  Vec3 direction =
      length(outward) > 1e-6 * static_cast<double>(seam.points.size()) ? normalized(outward) : Vec3{0, 0, 1};
  if (direction.y < 0.25) direction.y = 0.25;
  return seam_camera_from(seam, normalized(direction), aspect, fov_deg, margin);
}

// point - eye = s (corner + x right + y down): Cramer's rule for (s, s x, s y).
std::optional<PicturePoint> projected(const render::Camera& camera, const render::Rays& rays, const Vec3& point) {
  const Vec3 d = point - camera.eye;
  const double determinant = dot(rays.corner, cross(rays.right, rays.down));
  const double s = dot(d, cross(rays.right, rays.down)) / determinant;
  if (!(s > 0)) return std::nullopt;
  return PicturePoint{dot(rays.corner, cross(d, rays.down)) / determinant / s,
                      dot(rays.corner, cross(rays.right, d)) / determinant / s};
}

}  // namespace goniochrome::panels
