#include "render/path/visible_surface.h"

#include <algorithm>
#include <limits>

#include "base/parallel.h"

namespace goniochrome::render {

namespace {

// Calls visit(pixel, hit, direction) for each pixel of which a ray, this far from its center, meets something.
template <class Visit>
void visit_hits(const rays::RayScene& scene, const Rays& rays, int width, int height,
                const std::array<double, 2>& shift, const Visit& visit) {
  const rays::Float3 eye = scene.local(rays.eye);
  parallel_each(static_cast<std::size_t>(height), 8, [&](std::size_t y) {
    for (int x = 0; x < width; x += 8) {
      rays::Fan fan;
      fan.origin = eye;
      for (int i = 0; i < 8; ++i) {
        const rays::Float3 d = rays::float3(
            rays.direction(std::min(x + i, width - 1) + 0.5 + shift[0], static_cast<double>(y) + 0.5 + shift[1]));
        fan.x[i] = d.x, fan.y[i] = d.y, fan.z[i] = d.z;
        if (x + i < width) fan.wanted |= 1U << i;
      }
      rays::Hit hits[8];
      scene.closest(fan, hits);
      for (int i = 0; i < 8; ++i)
        if (hits[i].any())
          visit(y * static_cast<std::size_t>(width) + static_cast<std::size_t>(x + i), hits[i],
                rays::Float3{fan.x[i], fan.y[i], fan.z[i]});
    }
  });
}

}  // namespace

Gbuffer visible_surface(const rays::RayScene& scene, const Rays& rays, int width, int height) {
  Gbuffer g;
  g.width = width, g.height = height, g.rays = rays;
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  g.data.assign(4 * pixels, 0.0F), g.triangles.assign(pixels, kNoTriangle);
  const rays::Float3 eye = scene.local(rays.eye);
  visit_hits(scene, rays, width, height, {}, [&](std::size_t at, const rays::Hit& hit, const rays::Float3& direction) {
    const rays::Spot spot = scene.spot(hit, eye, direction);
    const int part = spot.inside ? -(spot.part + 1) : spot.part + 1;
    const float data[4] = {spot.shading.x, spot.shading.y, spot.shading.z, static_cast<float>(part)};
    std::ranges::copy(data, &g.data[4 * at]);
    g.triangles[at] = hit.triangle;
  });
  return g;
}

Gbuffer mesh_gbuffer(const rays::RayScene& scene, const Rays& rays, int width, int height) {
  Gbuffer g = visible_surface(scene, rays, width, height);
  for (std::size_t i = 0; i < g.triangles.size(); ++i)
    if (g.triangles[i] == rays::kFloor) std::fill_n(&g.data[4 * i], 4, 0.0F), g.triangles[i] = kNoTriangle;
  return g;
}

Coverage coverage(const rays::RayScene& scene, const Rays& rays, int width, int height,
                  const std::vector<std::array<double, 2>>& shifts) {
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  Coverage result{std::vector<std::uint16_t>(pixels, 0), std::vector<std::uint16_t>(pixels, 0)};
  for (std::size_t sample = 0; sample < shifts.size(); ++sample) {
    const auto bit = static_cast<std::uint16_t>(1U << sample);
    visit_hits(scene, rays, width, height, shifts[sample],
               [&](std::size_t at, const rays::Hit& hit, const rays::Float3&) {
                 result.any[at] |= bit;
                 if (hit.triangle == rays::kFloor) result.floor[at] |= bit;
               });
  }
  return result;
}

rays::Spot spot_at(const rays::RayScene& scene, const Gbuffer& g, int x, int y) {
  const rays::Float3 eye = scene.local(g.rays.eye), direction = rays::float3(g.rays.direction(x + 0.5, y + 0.5));
  const std::uint32_t triangle = g.triangles[g.index(x, y)];
  if (triangle == rays::kFloor) return scene.spot(floor_hit(scene, eye, direction), eye, direction);
  const auto [a, b, c] = scene.corners(triangle);
  const std::array<double, 3> shares =
      within(plane_hit({rays::vec3(a), rays::vec3(b), rays::vec3(c)}, rays::vec3(eye), rays::vec3(direction)).shares);
  return scene.spot({triangle, static_cast<float>(shares[1]), static_cast<float>(shares[2]), 0}, eye, direction);
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
