#include "render/plan/pane_probe.h"

#include "render/panes.h"

namespace goniochrome::render {

namespace {

color::Rgb background(const Scene& scene, const Vec3& direction) {
  if (scene.background == Background::kColor) return scene.background_color;
  const bool shown = scene.background == Background::kEnvironment && scene.env != nullptr;
  if (!shown || scene.env->mirror.map.size == 0) return {};
  return envmap::bilinear(scene.env->mirror.map, direction);
}

}  // namespace

void PaneProbe::add(const std::vector<color::Rgb>& of_behind, std::vector<color::Rgb>& colors) const {
  for (const Share& share : shares) colors[share.point] += share.passed * of_behind[share.behind];
  for (const Beyond& seen : beyond) colors[seen.point] += seen.light;
}

PaneProbe pane_probe(const rays::RayScene* whole, const Scene& scene, const std::vector<ProbePixel>& pixels) {
  PaneProbe probe;
  if (whole == nullptr || !has_panes(scene)) return probe;
  for (std::size_t point = 0; point < pixels.size(); ++point) {
    const auto& [g, x, y] = pixels[point];
    if (!is_pane(scene, static_cast<std::size_t>(g->part(x, y)))) continue;
    const Vec3 to_viewer = g->to_viewer(x, y);
    const rays::Float3 direction = -rays::float3(to_viewer);
    const MeshPoint at = mesh_point(*scene.mesh, *g, x, y);
    rays::Spot spot = whole->spot({at.triangle, static_cast<float>(at.shares[1]), static_cast<float>(at.shares[2]), 0},
                                  whole->local(g->rays.eye), direction);
    double share = 1;
    while (share > kLeastPassed) {
      const PassedPane passed = through_pane(*whole, spot, direction);
      share *= passed.passed;
      if (!passed.hit.any() || passed.hit.triangle == rays::kFloor) {
        probe.beyond.push_back({point, share * background(scene, -to_viewer)});
        break;
      }
      spot = whole->spot(passed.hit, spot.position, direction);
      VisiblePoint behind;
      behind.normal = rays::vec3(spot.shading), behind.to_viewer = to_viewer, behind.part = spot.part;
      behind.position = whole->world(spot.position);
      probe.shares.push_back({point, probe.behind.size(), share});
      probe.behind.push_back(behind);
      probe.ray_points.push_back({spot, -direction});
      if (!is_pane(scene, static_cast<std::size_t>(spot.part))) break;
    }
  }
  return probe;
}

}  // namespace goniochrome::render
