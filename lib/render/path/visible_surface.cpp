#include "render/path/visible_surface.h"

#include <algorithm>
#include <limits>

#include "base/parallel.h"

namespace goniochrome::render {

namespace {

// Normals of pixels beside each other that have at least this cosine lie on no edge. Beside pictures of four rays in
// all pixels (1280 x 720, three meshes in two probes), 26 pixels at most differed by more than 2 dE00; by 0.998 30 did.
constexpr float kNoEdge = 0.9995F;

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

void put(const rays::RayScene& scene, const rays::Hit& hit, const rays::Float3& eye, const rays::Float3& direction,
         std::size_t at, Gbuffer& g) {
  const rays::Spot spot = scene.spot(hit, eye, direction);
  const int part = spot.inside ? -(spot.part + 1) : spot.part + 1;
  const float data[4] = {spot.shading.x, spot.shading.y, spot.shading.z, static_cast<float>(part)};
  std::ranges::copy(data, &g.data[4 * at]);
  g.triangles[at] = hit.triangle;
}

void clear(std::size_t at, Gbuffer& g) {
  std::fill_n(&g.data[4 * at], 4, 0.0F), g.triangles[at] = kNoTriangle;
}

// Finds the surface at all samples of these pixels.
void look_at(const rays::RayScene& scene, const std::vector<std::size_t>& pixels, std::vector<Gbuffer>& samples) {
  const rays::Float3 eye = scene.local(samples.front().rays.eye);
  const std::size_t count = samples.size(), all = count * pixels.size();
  parallel_each((all + 7) / 8, 64, [&](std::size_t chunk) {
    rays::Fan fan;
    fan.origin = eye;
    const std::size_t first = 8 * chunk, rays = std::min<std::size_t>(8, all - first);
    for (std::size_t i = 0; i < rays; ++i) {
      const Gbuffer& g = samples[(first + i) % count];
      const auto width = static_cast<std::size_t>(g.width), at = pixels[(first + i) / count];
      const rays::Float3 d =
          rays::float3(g.rays.direction(static_cast<double>(at % width) + 0.5, static_cast<double>(at / width) + 0.5));
      fan.x[i] = d.x, fan.y[i] = d.y, fan.z[i] = d.z;
      fan.wanted |= 1U << i;
    }
    rays::Hit hits[8];
    scene.closest(fan, hits);
    for (std::size_t i = 0; i < rays; ++i) {
      Gbuffer& g = samples[(first + i) % count];
      const std::size_t at = pixels[(first + i) / count];
      clear(at, g);
      if (hits[i].any()) put(scene, hits[i], eye, {fan.x[i], fan.y[i], fan.z[i]}, at, g);
    }
  });
}

bool are_alike(const float* a, const float* b) {
  return are_one_piece(a, b, kNoEdge) || (a[3] == 0 && b[3] == 0);
}

bool is_amid_one_piece(const Gbuffer& centers, int x, int y) {
  if (x == 0 || y == 0 || x == centers.width - 1 || y == centers.height - 1) return false;
  for (int v = y - 1; v <= y + 1; ++v)
    for (int u = x - 1; u <= x + 1; ++u)
      if (!are_alike(centers.at(x, y), centers.at(u, v))) return false;
  return true;
}

// Flags the pixels about those whose samples show more than one piece, and returns those that are new.
std::vector<std::size_t> beside_edges(const std::vector<std::size_t>& pixels, const std::vector<Gbuffer>& samples,
                                      PixelFlags& edges) {
  const Gbuffer& first = samples.front();
  std::vector<std::size_t> found;
  for (const std::size_t at : pixels) {
    const auto x = static_cast<int>(at % static_cast<std::size_t>(first.width)),
               y = static_cast<int>(at / static_cast<std::size_t>(first.width));
    if (std::ranges::all_of(samples, [&](const Gbuffer& g) { return are_alike(g.at(x, y), first.at(x, y)); })) continue;
    for (int v = std::max(0, y - 1); v <= std::min(first.height - 1, y + 1); ++v)
      for (int u = std::max(0, x - 1); u <= std::min(first.width - 1, x + 1); ++u)
        if (std::uint8_t& flag = edges[first.index(u, v)]; flag == 0) flag = 1, found.push_back(first.index(u, v));
  }
  return found;
}

// The normals of a pixel's samples where one piece is all about it.
void turn_normal(const Gbuffer& centers, int x, int y, const std::vector<std::array<double, 2>>& shifts,
                 std::vector<Gbuffer>& samples) {
  const auto at = [&](int u, int v) {
    const float* n = centers.at(u, v);
    return rays::Float3{n[0], n[1], n[2]};
  };
  const rays::Float3 normal = at(x, y), across = 0.5F * (at(x + 1, y) - at(x - 1, y)),
                     down = 0.5F * (at(x, y + 1) - at(x, y - 1));
  for (std::size_t k = 0; k < shifts.size(); ++k) {
    const rays::Float3 turned =
        rays::normalized(normal + static_cast<float>(shifts[k][0]) * across + static_cast<float>(shifts[k][1]) * down);
    float* to = &samples[k].data[4 * centers.index(x, y)];
    to[0] = turned.x, to[1] = turned.y, to[2] = turned.z;
  }
}

}  // namespace

Gbuffer visible_surface(const rays::RayScene& scene, const Rays& rays, int width, int height) {
  Gbuffer g;
  g.width = width, g.height = height, g.rays = rays;
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  g.data.assign(4 * pixels, 0.0F), g.triangles.assign(pixels, kNoTriangle);
  const rays::Float3 eye = scene.local(rays.eye);
  visit_hits(scene, rays, width, height, {}, [&](std::size_t at, const rays::Hit& hit, const rays::Float3& direction) {
    put(scene, hit, eye, direction, at, g);
  });
  return g;
}

Gbuffer mesh_gbuffer(const rays::RayScene& scene, const Rays& rays, int width, int height) {
  Gbuffer g = visible_surface(scene, rays, width, height);
  for (std::size_t i = 0; i < g.triangles.size(); ++i)
    if (g.triangles[i] == rays::kFloor) clear(i, g);
  return g;
}

SampledSurface sampled_surface(const rays::RayScene& scene, const Gbuffer& centers,
                               const std::vector<std::array<double, 2>>& shifts) {
  SampledSurface result;
  auto& [samples, edges] = result;
  samples.resize(shifts.size());
  parallel_each(shifts.size(), 1, [&](std::size_t k) {
    samples[k] = centers;
    samples[k].rays = centers.rays.shifted(shifts[k][0], shifts[k][1]);
  });
  edges.resize(centers.triangles.size());
  for_pixels(centers.width, centers.height,
             [&](int x, int y) { edges[centers.index(x, y)] = is_amid_one_piece(centers, x, y) ? 0 : 1; });
  std::vector<std::size_t> pixels;
  for (std::size_t at = 0; at < edges.size(); ++at)
    if (edges[at] != 0) pixels.push_back(at);
  while (!pixels.empty()) {
    look_at(scene, pixels, samples);
    pixels = beside_edges(pixels, samples, edges);
  }
  for_pixels(centers.width, centers.height, [&](int x, int y) {
    if (centers.part(x, y) >= 0 && edges[centers.index(x, y)] == 0) turn_normal(centers, x, y, shifts, samples);
  });
  return result;
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
