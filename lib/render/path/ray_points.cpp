#include "render/path/ray_points.h"

#include <algorithm>
#include <limits>

namespace goniochrome::render {

RayPoint ray_point(const rays::RayScene& scene, const mesh::Mesh& mesh, const Gbuffer& gbuffer, int x, int y) {
  const MeshPoint at = mesh_point(mesh, gbuffer, x, y);
  const rays::Hit hit{at.triangle, static_cast<float>(at.shares[1]), static_cast<float>(at.shares[2]), 0};
  const Vec3 to_viewer = gbuffer.to_viewer(x, y);
  return {scene.spot(hit, scene.local(gbuffer.rays.eye), rays::float3(-to_viewer)), rays::float3(to_viewer)};
}

rays::Hit floor_hit(const rays::RayScene& scene, const rays::Float3& eye, const rays::Float3& direction) {
  const float distance = scene.floor_distance(eye, direction);
  if (!(distance < std::numeric_limits<float>::infinity())) return {};
  return {rays::kFloor, 0, 0, distance};
}

std::vector<RayPoint> floor_points(const rays::RayScene& scene, const Gbuffer& g, std::size_t most) {
  const rays::Float3 eye = scene.local(g.rays.eye);
  const std::size_t pixels = g.data.size() / 4;
  // Most pixels may show the mesh or what is above the horizon: several times as many are looked at.
  const std::size_t step = pixels / (4 * most) | 1;
  std::vector<RayPoint> found;
  for (std::size_t i = step / 2; i < pixels; i += step) {
    const int x = static_cast<int>(i) % g.width, y = static_cast<int>(i) / g.width;
    if (g.part(x, y) >= 0) continue;
    const rays::Float3 direction = -rays::float3(g.to_viewer(x, y));
    const rays::Hit hit = floor_hit(scene, eye, direction);
    if (hit.any()) found.push_back({scene.spot(hit, eye, direction), -direction});
  }
  const std::size_t thin = std::max<std::size_t>(1, (found.size() + most - 1) / most);
  std::vector<RayPoint> points;
  for (std::size_t i = 0; i < found.size(); i += thin) points.push_back(found[i]);
  return points;
}

}  // namespace goniochrome::render
