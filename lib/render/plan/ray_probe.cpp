#include "render/plan/ray_probe.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/clock.h"
#include "base/parallel.h"
#include "render/internal/seen.h"
#include "render/path/noise.h"

namespace goniochrome::render {

namespace {

// Rounds of sampling: the share of the points that take part, and the batches that these then have. A percentile is
// decided by the points about it, so that later rounds go to those that seem to be worth most. Their shares are several
// times the twentieth of the points that lies above the percentile: noise puts points out of their order.
struct Round {
  double share;
  int batches;
};
constexpr Round kRounds[] = {{1, 2}, {0.3, 8}, {0.1, 32}};
// Below this, in CIEDE2000, nobody needs to know a percentile more accurately.
constexpr double kLeastPercentile = 0.1;
// Points that are traced once more without light that is passed on, for the time of that.
constexpr std::size_t kTimed = 64;

// The batches from `first` in steps of `step`.
LightShares mean_of(const std::vector<LightShares>& batches, std::size_t first, std::size_t step) {
  LightShares sum;
  int count = 0;
  for (std::size_t i = first; i < batches.size(); i += step, ++count) sum += batches[i];
  return count > 0 ? (1.0 / count) * sum : sum;
}

// Of what the effects add, by one batch.
Covariance covariance_of(const std::vector<LightShares>& batches, const RayEffects& with, const RayEffects& without) {
  Estimates values;
  for (const LightShares& batch : batches) values.add(batch.shown(with) - batch.shown(without));
  return values.covariance();
}

// The three comparisons that a plan makes.
struct Comparison {
  RayEffects with, without;
};
constexpr RayEffects kAll{true, true, true};
constexpr Comparison kComparisons[] = {{kAll, {}}, {kAll, {true, false, true}}, {kAll, {true, true, false}}};

std::size_t place_of_percentile(std::size_t count) {
  return (count * 95 + 99) / 100 - 1;
}

}  // namespace

RayPoint ray_point(const rays::RayScene& scene, const mesh::Mesh& mesh, const Gbuffer& gbuffer, int x, int y) {
  const MeshPoint at = mesh_point(mesh, gbuffer, x, y);
  const rays::Hit hit{at.triangle, static_cast<float>(at.shares[1]), static_cast<float>(at.shares[2]), 0};
  const Vec3 to_viewer = gbuffer.to_viewer(x, y);
  return {scene.spot(hit, scene.local(gbuffer.rays.eye), rays::float3(-to_viewer)), rays::float3(to_viewer)};
}

RayProbe RayProbe::traced(const Transport& transport, const std::vector<RayPoint>& points, std::vector<color::Rgb> base,
                          double white_luminance, int bounces, std::uint64_t seed) {
  RayProbe probe;
  probe.points_.resize(points.size());
  probe.base_ = std::move(base);
  probe.white_ = white_luminance > 0 ? white_luminance : 1;
  probe.bounces_ = bounces;
  if (points.empty()) return probe;
  for (const auto& [share, batches] : kRounds) {
    const Stopwatch clock;
    const std::vector<int> more = probe.more(share, batches);
    probe.trace(transport, points, more, seed);
    if (share < 1) continue;
    probe.passed_ms_ = 1000 * clock.elapsed_s() / static_cast<double>(batches * points.size());
    for (const Point& point : probe.points_) probe.blocked_ += point.blocked ? 1 : 0;
    if (probe.free()) return probe;
  }

  RayProbe plain;
  plain.points_.resize(std::min(points.size(), kTimed));
  std::vector<RayPoint> some;
  for (std::size_t i = 0; i < plain.points_.size(); ++i)
    some.push_back(points[i * points.size() / plain.points_.size()]);
  const Stopwatch plain_clock;
  plain.trace(transport, some, std::vector<int>(some.size(), 1), seed);
  probe.direct_ms_ =
      std::min(probe.passed_ms_, 1000 * plain_clock.elapsed_s() / static_cast<double>(plain.points_.size()));
  return probe;
}

void RayProbe::trace(const Transport& transport, const std::vector<RayPoint>& points, const std::vector<int>& more,
                     std::uint64_t seed) {
  PathOptions options;
  options.bounces = bounces_;
  options.correction = true;
  constexpr std::size_t kTogether = 4;
  parallel_for(points.size(), kTogether, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (more[i] == 0) continue;
      Point& point = points_[i];
      const PointTransport at(transport, options, points[i].spot, points[i].to_viewer);
      point.certain = at.certain();
      point.sure = {at.sure(), {}, {}};
      point.blocked = point.blocked || at.sure() != color::Rgb{};
      for (int k = 0; k < more[i] && !point.certain; ++k) {
        bool blocked = false;
        point.batches.push_back(at.batch_shares(mixed(mixed(seed, i), point.batches.size()), 0, kBatch, &blocked));
        point.blocked = point.blocked || blocked;
      }
    }
  });
}

// The further batches that bring this share of the points to so many, those first that seem to be worth most.
std::vector<int> RayProbe::more(double share, int batches) const {
  std::vector<int> more(points_.size(), batches);
  if (share < 1) {
    std::vector<double> rank(points_.size(), 0);
    for (const auto& [with, without] : kComparisons) {
      const double p95 = std::max(kLeastPercentile, worth(with, without).de00_p95);
      for (std::size_t i = 0; i < points_.size(); ++i)
        rank[i] = std::max(rank[i], std::sqrt(std::max(0.0, squared_difference(i, with, without))) / p95);
    }
    std::vector<std::size_t> order(points_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return rank[a] > rank[b]; });
    const auto taken = static_cast<std::size_t>(share * static_cast<double>(order.size()));
    for (std::size_t k = taken; k < order.size(); ++k) more[order[k]] = 0;
  }
  for (std::size_t i = 0; i < more.size(); ++i)
    more[i] = std::max(0, more[i] - static_cast<int>(points_[i].batches.size()));
  return more;
}

color::Rgb RayProbe::added(std::size_t i, const RayEffects& effects) const {
  const Point& point = points_[i];
  return point.sure.shown(effects) + mean_of(point.batches, 0, 1).shown(effects);
}

// With n batches the expectation of the squared difference is d^2 + c/n + O(1/n^2), whatever the metric: c holds the
// variance and the curvature. Halves of the batches have twice the excess, which takes it off.
double RayProbe::squared_difference(std::size_t i, const RayEffects& with, const RayEffects& without) const {
  const Point& point = points_[i];
  const auto squared = [&](const LightShares& mean) {
    const LightShares sum = {point.sure.direct + mean.direct, mean.into_lobes, mean.into_diffuse};
    const double d = seen_difference(base_[i] + sum.shown(with), base_[i] + sum.shown(without), white_);
    return d * d;
  };
  const double whole = squared(mean_of(point.batches, 0, 1));
  if (point.batches.size() < 2) return whole;
  return 2 * whole - 0.5 * (squared(mean_of(point.batches, 0, 2)) + squared(mean_of(point.batches, 1, 2)));
}

// The percentile's own error: of n points the k-th in order lies between those that are one standard deviation of the
// binomial distribution of n and 0.95 away from it.
Worth RayProbe::worth(const RayEffects& with, const RayEffects& without) const {
  if (points_.empty()) return {};
  std::vector<double> de00;
  for (std::size_t i = 0; i < points_.size(); ++i)
    de00.push_back(std::sqrt(std::max(0.0, squared_difference(i, with, without))));
  std::ranges::sort(de00);
  const std::size_t n = de00.size(), k = place_of_percentile(n);
  const auto spread = static_cast<std::size_t>(std::lround(std::sqrt(0.95 * 0.05 * static_cast<double>(n))));
  return {de00[k], 0.5 * (de00[std::min(n - 1, k + spread)] - de00[k - std::min(k, spread)])};
}

// As path_picture() shares out its samples.
RayCost RayProbe::cost(const RayEffects& effects, double tolerance_de00, double visible_points, int samples) const {
  RayCost cost;
  if (!effects.shadow || points_.empty()) return cost;
  constexpr double kFewest = 2;
  const double tolerance = tolerance_de00 * std::sqrt(samples);
  std::vector<double> needed;
  std::size_t traced = 0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Point& point = points_[i];
    traced += point.certain ? 0 : 1;
    const double one =
        noise_de00(base_[i] + added(i, effects), covariance_of(point.batches, effects, {}), white_) / tolerance;
    needed.push_back(point.certain ? 0 : one * one);
  }
  const double most = std::max(kFewest, std::ceil(1.05 * percentile_95(needed)));
  double batches = 0;
  for (std::size_t i = 0; i < points_.size(); ++i)
    batches += points_[i].certain ? 0 : std::clamp(std::ceil(needed[i]), kFewest, most);
  const double n = static_cast<double>(points_.size());
  cost.traced_share = static_cast<double>(traced) / n;
  cost.samples = kBatch * samples * batches / n;
  cost.ms = samples * visible_points * batches / n * (effects.self || effects.bounce ? passed_ms_ : direct_ms_);
  return cost;
}

}  // namespace goniochrome::render
