#include "render/plan/floor_probe.h"

#include <algorithm>
#include <cmath>

#include "base/clock.h"
#include "base/parallel.h"
#include "render/internal/seen.h"

namespace goniochrome::render {

namespace {

color::Rgb behind(const Scene& scene, const envmap::Environment* environment, const Vec3& direction) {
  if (scene.background == Background::kColor) return scene.background_color;
  if (scene.background == Background::kNone || environment == nullptr) return {};
  return smooth_radiance(*environment, direction);
}

}  // namespace

FloorPixels floor_pixels(const Transport& over_floor, const Scene& scene, const envmap::Environment* environment,
                         const std::vector<std::shared_ptr<const Gbuffer>>& gbuffers, std::size_t most) {
  const rays::RayScene& traced = over_floor.rays();
  FloorPixels pixels;
  std::size_t all = 0;
  for (const auto& g : gbuffers) all += g->data.size() / 4;
  // Most pixels may show the mesh or what is above the horizon: several times as many are looked at.
  const std::size_t stride = std::max<std::size_t>(1, all / (4 * most)) | 1;
  std::size_t met = stride / 2, looked_at = 0;
  std::vector<FloorPoint> found;
  for (const auto& g : gbuffers) {
    const rays::Float3 eye = traced.local(g->rays.eye);
    for (std::size_t i = 0; i < g->data.size() / 4; ++i) {
      if (++met % stride != 0) continue;
      ++looked_at;
      if (g->data[4 * i + 3] != 0) continue;
      const int x = static_cast<int>(i) % g->width, y = static_cast<int>(i) / g->width;
      const Vec3 toward = -g->to_viewer(x, y);
      const rays::Float3 direction = rays::float3(toward);
      const float distance = traced.floor_distance(eye, direction);
      if (!(distance < std::numeric_limits<float>::infinity())) continue;
      const rays::Spot spot = traced.spot({rays::kFloor, 0, 0, distance}, eye, direction);
      found.push_back({{g.get(), x, y}, {spot, -direction}, behind(scene, environment, toward)});
    }
  }
  if (found.empty()) return pixels;
  pixels.count = static_cast<double>(found.size()) * static_cast<double>(all) / static_cast<double>(looked_at);
  const std::size_t step = (found.size() + most - 1) / most;
  for (std::size_t i = 0; i < found.size(); i += step) pixels.points.push_back(found[i]);
  return pixels;
}

FloorProbe::FloorProbe(const Transport& over_floor, double white_luminance, const FloorPixels& pixels) {
  const std::size_t n = pixels.points.size();
  if (n == 0) return;
  const double white = white_luminance > 0 ? white_luminance : 1;
  std::vector<double> de00(n);
  const Stopwatch clock;
  parallel_for(n, 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const FloorPoint& point = pixels.points[i];
      de00[i] = seen_difference(over_floor.shaded_ground(point.at.spot).sum(), point.instead, white);
    }
  });
  point_ms_ = 1000 * clock.elapsed_s() / static_cast<double>(n);
  std::ranges::sort(de00);
  const std::size_t k = (n * 95 + 99) / 100 - 1;
  const auto spread = static_cast<std::size_t>(std::lround(std::sqrt(0.95 * 0.05 * static_cast<double>(n))));
  worth_ = {de00[k], 0.5 * (de00[std::min(n - 1, k + spread)] - de00[k - std::min(k, spread)])};
}

}  // namespace goniochrome::render
