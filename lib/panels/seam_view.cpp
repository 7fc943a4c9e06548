#include "panels/seam_view.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/text.h"

namespace goniochrome::panels {

namespace {

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

bool SeamTexts::names_anything_but_mesh() const {
  return !seam.empty() || !environment.empty() || !lights_from.empty() || !views_from.empty();
}

Result<SeamWorld> seam_world(const SeamTexts& texts) {
  SeamWorld world;
  const auto parts = split(texts.seam, ',');
  if (parts.size() != 2 || trimmed(parts[0]).empty() || trimmed(parts[1]).empty())
    return usage_error("--seam is \"{}\": name two parts of the mesh, A,B", texts.seam);
  world.part_a = trimmed(parts[0]), world.part_b = trimmed(parts[1]);
  world.seam.unit_m = texts.unit == "m" ? 1 : texts.unit == "cm" ? 1e-2 : texts.unit == "mm" ? 1e-3 : 0;
  world.seam.max_gap_mm = texts.max_gap_mm;
  GONIO_ASSIGN(world.lights, directions_of("--light-from", texts.lights_from));
  GONIO_ASSIGN(world.viewers, directions_of("--view-from", texts.views_from));
  if (!world.lights.empty() && !texts.environment.empty())
    return usage_error("--light-from and --environment exclude each other");
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
  // Told once, by the file's name, and not for every paint.
  if (auto panels = EnvironmentPanels::make(stage.env, {}); !panels.ok())
    return input_error("{}: {}", texts.environment, panels.error().message);
  return stage;
}

std::string seam_light_text(const SeamTexts& texts, const SeamWorld& world, const GeometryList& geometries) {
  constexpr const char* kLeftOut = "left out: gloss, and shadows and reflections of the mesh on itself\n";
  if (!world.in_world)
    return fmt::format("{} pairs of light and viewer at every place, the light from both sides of the seam\n{}",
                       geometries.pairs.size(), kLeftOut);
  return fmt::format(
      "{} viewers in the world, {}\n{}", world.viewers.size(),
      texts.environment.empty() ? fmt::format("{} lights", world.lights.size()) : "light of " + texts.environment,
      kLeftOut);
}

// The sphere about the middle of the seam's box that holds all places just fits between the borders that are nearer.
render::Camera seam_camera_from(const mesh::Seam& seam, const Vec3& direction, double aspect, double fov_deg,
                                double margin) {
  mesh::Box box{seam.points.front().a, seam.points.front().a};
  for (const mesh::SeamPoint& p : seam.points)
    for (int c = 0; c < 3; ++c) {
      box.low[c] = std::min({box.low[c], p.a[c], p.b[c]});
      box.high[c] = std::max({box.high[c], p.a[c], p.b[c]});
    }
  const Vec3 middle = 0.5 * (box.low + box.high);
  double radius = 0;
  for (const mesh::SeamPoint& p : seam.points) radius = std::max(radius, length(p.a - middle));
  const double half = fov_deg / 2 * kPi / 180;
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
