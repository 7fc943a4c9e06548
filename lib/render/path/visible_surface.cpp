#include "render/path/visible_surface.h"

#include <algorithm>
#include <limits>

#include "base/parallel.h"

namespace goniochrome::render {

namespace {

constexpr std::size_t kSurfaceRowsAtOnce = 8;

// Calls visit(pixel, hit, direction) for each pixel of which a ray, this far from its center, meets something.
template <class Visit>
void visit_hits(const rays::RayScene& scene, const Rays& rays, int width, int height,
                const std::array<double, 2>& shift, const Visit& visit) {
  const rays::Float3 eye = scene.local(rays.eye);
  parallel_for(static_cast<std::size_t>(height), kSurfaceRowsAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) {
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
    }
  });
}

}  // namespace

VisibleSurface visible_surface(const rays::RayScene& scene, const Rays& rays, int width, int height) {
  VisibleSurface surface;
  Gbuffer& g = surface.gbuffer;
  g.width = width, g.height = height, g.rays = rays;
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  g.data.assign(4 * pixels, 0.0F);
  surface.hits.resize(pixels);
  const rays::Float3 eye = scene.local(rays.eye);
  visit_hits(scene, rays, width, height, {}, [&](std::size_t at, const rays::Hit& hit, const rays::Float3& direction) {
    const rays::Spot spot = scene.spot(hit, eye, direction);
    const int part = spot.inside ? -(spot.part + 1) : spot.part + 1;
    const float data[4] = {spot.shading.x, spot.shading.y, spot.shading.z, static_cast<float>(part)};
    std::ranges::copy(data, &g.data[4 * at]);
    surface.hits[at] = hit;
  });
  return surface;
}

Gbuffer mesh_gbuffer(const rays::RayScene& scene, const Rays& rays, int width, int height) {
  VisibleSurface surface = visible_surface(scene, rays, width, height);
  Gbuffer gbuffer = std::move(surface.gbuffer);
  gbuffer.triangles.assign(surface.hits.size(), kNoTriangle);
  for (std::size_t i = 0; i < surface.hits.size(); ++i) {
    if (surface.hits[i].triangle == rays::kFloor) {
      std::fill_n(&gbuffer.data[4 * i], 4, 0.0F);
    } else if (surface.hits[i].any()) {
      gbuffer.triangles[i] = surface.hits[i].triangle;
    }
  }
  return gbuffer;
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

rays::Spot spot_at(const rays::RayScene& scene, const VisibleSurface& surface, int x, int y) {
  const Gbuffer& g = surface.gbuffer;
  return scene.spot(surface.hits[static_cast<std::size_t>(y) * g.width + x], scene.local(g.rays.eye),
                    rays::float3(g.rays.direction(x + 0.5, y + 0.5)));
}

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
