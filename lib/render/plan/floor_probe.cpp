#include "render/plan/floor_probe.h"

#include <algorithm>
#include <cmath>

#include "base/clock.h"
#include "base/parallel.h"
#include "render/internal/seen.h"
#include "render/path/noise.h"
#include "render/path/ray_correction.h"

namespace goniochrome::render {

namespace {

constexpr int kFans = 8;  // of each point that needs samples

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
      found.push_back(
          {{spot, -direction}, behind(scene, environment, toward), over_floor.hidden_share(spot) > kUnseenShare});
    }
  }
  if (found.empty()) return pixels;
  pixels.count = static_cast<double>(found.size()) * static_cast<double>(all) / static_cast<double>(looked_at);
  const auto near = static_cast<double>(std::ranges::count_if(found, &FloorPoint::is_near));
  pixels.near_count = pixels.count * near / static_cast<double>(found.size());
  const std::size_t step = (found.size() + most - 1) / most;
  for (std::size_t i = 0; i < found.size(); i += step) pixels.points.push_back(found[i]);
  return pixels;
}

FloorProbe::FloorProbe(const ProbeSetting& setting, const FloorPixels& pixels)
    : pixels_(pixels), light_(pixels.points.size()), white_(setting.white_luminance > 0 ? setting.white_luminance : 1) {
  PathOptions options;
  options.bounces = setting.bounces;
  options.correction = true;
  const Stopwatch clock;
  parallel_for(light_.size(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const FloorPoint& point = pixels.points[i];
      const PointTransport at(*setting.transport, options, point.at.spot, point.at.to_viewer);
      light_[i].sure = {at.sure(), {}, {}};
      for (int k = 0; k < kFans && point.is_near; ++k)
        light_[i].fans.push_back(at.batch_shares(mixed(mixed(setting.seed, 0x466C), i * kFans + k), 0, kFan));
    }
  });
  const auto traced = static_cast<double>(std::ranges::count_if(pixels.points, &FloorPoint::is_near));
  if (traced > 0) batch_ms_ = 1000 * clock.elapsed_s() / (traced * kFans);
}

LightShares FloorProbe::mean(std::size_t i, std::size_t first, std::size_t step) const {
  const Light& light = light_[i];
  LightShares sum;
  int count = 0;
  for (std::size_t k = first; k < light.fans.size(); k += step, ++count) sum += light.fans[k];
  LightShares all = light.sure;
  if (count > 0) all += (1.0 / count) * sum;
  return all;
}

Worth FloorProbe::worth() const {
  std::vector<double> de00;
  for (std::size_t i = 0; i < light_.size(); ++i) {
    const auto squared = [&](std::size_t first, std::size_t step) {
      const double d = seen_difference(mean(i, first, step).sum(), pixels_.points[i].instead, white_);
      return d * d;
    };
    const double whole = squared(0, 1);
    de00.push_back(light_[i].fans.size() < 2
                       ? std::sqrt(whole)
                       : std::sqrt(std::max(0.0, 2 * whole - 0.5 * (squared(0, 2) + squared(1, 2)))));
  }
  if (de00.empty()) return {};
  std::ranges::sort(de00);
  const std::size_t n = de00.size(), k = (n * 95 + 99) / 100 - 1;
  const auto spread = static_cast<std::size_t>(std::lround(std::sqrt(0.95 * 0.05 * static_cast<double>(n))));
  return {de00[k], 0.5 * (de00[std::min(n - 1, k + spread)] - de00[k - std::min(k, spread)])};
}

// As path_picture() shares out its samples, whose batches are half as long on a floor.
RayCost FloorProbe::cost(const RayEffects& effects, double tolerance_de00, double floor_pixels, int samples) const {
  RayCost cost;
  if (light_.empty()) return cost;
  constexpr double kFewest = 2;
  const double groups = std::ceil(samples / 4.0), tolerance = tolerance_de00 * std::sqrt(groups);
  std::vector<double> needed;
  for (std::size_t i = 0; i < light_.size(); ++i) {
    Estimates values;
    for (const LightShares& fan : light_[i].fans) values.add(fan.shown(effects));
    const double one =
        light_[i].fans.empty() ? 0 : noise_de00(mean(i, 0, 1).shown(effects), values.covariance(), white_) / tolerance;
    needed.push_back(one * one);
  }
  const double most = std::max(kFewest, std::ceil(1.05 * percentile_95(needed)));
  double fans = 0, traced = 0;
  for (std::size_t i = 0; i < light_.size(); ++i) {
    if (light_[i].fans.empty()) continue;
    fans += std::clamp(std::ceil(needed[i]), kFewest, most), ++traced;
  }
  const auto n = static_cast<double>(light_.size());
  cost.traced_share = traced / n;
  cost.samples = kFan * groups * fans / n;
  cost.most_samples = kFan * groups * most;
  cost.ms = groups * floor_pixels * fans / n * batch_ms_;
  return cost;
}

}  // namespace goniochrome::render
