#include "render/plan/ray_probe.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/clock.h"
#include "base/parallel.h"
#include "render/internal/seen.h"
#include "render/path/noise.h"
#include "render/path/path_tracer.h"

namespace goniochrome::render {

namespace {

// The points, and the fans of each in the first round. Rare bright paths hold much of the light that is passed on: a
// point that has seen none of them looks darker than it is, so that fewer points with more fans tell its worth better.
constexpr std::size_t kPoints = 2048;
constexpr int kFirstFans = 4;
// Those of them at which a floor is traced as well.
constexpr std::size_t kFloorPoints = 512;
// No point gets more fans than that, and all points together no more than so many.
constexpr int kMostFans = 128;
constexpr int kMostInAll = 65536;
constexpr int kMostRounds = 8;
// A percentile is known well enough when its standard error is within this part of it, or below what nobody sees.
constexpr double kSharpPart = 0.07, kUnseen = 0.03;
// A point may lie on either side of the percentile if it is no farther from it than so many standard errors.
constexpr double kDoubt = 2;
// Points that are traced once more without light that is passed on, for the time of that.
constexpr std::size_t kTimed = 64;

// The fans from `first` in steps of `step`.
LightShares mean_of(const std::vector<LightShares>& fans, std::size_t first, std::size_t step) {
  LightShares sum;
  int count = 0;
  for (std::size_t i = first; i < fans.size(); i += step, ++count) sum += fans[i];
  return count > 0 ? (1.0 / count) * sum : sum;
}

constexpr RayEffects kAll{true, true, true};

std::size_t place_of_percentile(std::size_t count) {
  return (count * 95 + 99) / 100 - 1;
}

// A step near the golden section of n that shares no factor with it: points taken in such steps are spread evenly, as
// many as there may be.
std::size_t scattering(std::size_t n) {
  auto step = static_cast<std::size_t>(0.6180339887 * static_cast<double>(n)) + 1;
  while (n > 1 && std::gcd(step, n) != 1) ++step;
  return step;
}

}  // namespace

RayPoint ray_point(const rays::RayScene& scene, const mesh::Mesh& mesh, const Gbuffer& gbuffer, int x, int y) {
  const MeshPoint at = mesh_point(mesh, gbuffer, x, y);
  const rays::Hit hit{at.triangle, static_cast<float>(at.shares[1]), static_cast<float>(at.shares[2]), 0};
  const Vec3 to_viewer = gbuffer.to_viewer(x, y);
  return {scene.spot(hit, scene.local(gbuffer.rays.eye), rays::float3(-to_viewer)), rays::float3(to_viewer)};
}

// The three comparisons that a plan makes, and that of the floor.
const std::vector<RayProbe::Comparison>& RayProbe::comparisons() {
  static const std::vector<Comparison> all = {
      {kAll, {}}, {kAll, {true, false, true}}, {kAll, {true, true, false}}, {kAll, kAll, true}};
  return all;
}

RayProbe RayProbe::traced(const ProbeSetting& setting, const std::vector<RayPoint>& points,
                          const std::vector<color::Rgb>& base) {
  RayProbe probe;
  probe.white_ = setting.white_luminance > 0 ? setting.white_luminance : 1;
  probe.visible_points_ = setting.visible_points;
  if (points.empty()) return probe;
  probe.floor_points_ = setting.without_floor != nullptr ? std::min(kFloorPoints, points.size()) : 0;
  probe.add_points(points, base, std::min(kPoints, points.size()));
  const Stopwatch clock;
  probe.trace(setting, std::vector<int>(probe.size(), kFirstFans));
  const double first_round_ms = 1000 * clock.elapsed_s();
  if (probe.free() && probe.floor_points_ == 0) return probe;
  probe.refine(setting);
  probe.time(setting, first_round_ms / static_cast<double>(probe.size() + probe.floor_points_));
  return probe;
}

// What the first round took is that of its points and of their fans. A few points are traced twice more without light
// that is passed on, in few fans and in many, which tells one from the other.
void RayProbe::time(const ProbeSetting& setting, double of_point_ms) {
  constexpr int kFew = 2, kMany = 10;
  RayProbe plain;
  for (std::size_t i = 0; i < std::min(size(), kTimed); ++i) plain.points_.push_back({points_[i].at, {}, {}, {}});
  ProbeSetting without = setting;
  without.bounces = 0;
  const auto traced_ms = [&](int fans) {
    const Stopwatch clock;
    plain.trace(without, std::vector<int>(plain.size(), fans));
    return 1000 * clock.elapsed_s() / static_cast<double>(plain.size());
  };
  const double few_ms = traced_ms(kFew), many_ms = traced_ms(kMany);
  direct_ms_ = std::clamp((many_ms - few_ms) / (kMany - kFew), 0.0, of_point_ms / kFirstFans);
  point_ms_ = std::clamp(few_ms - kFew * direct_ms_, 0.0, of_point_ms);
  passed_ms_ = std::max(direct_ms_, (of_point_ms - point_ms_) / kFirstFans);
}

void RayProbe::add_points(const std::vector<RayPoint>& points, const std::vector<color::Rgb>& base, std::size_t count) {
  const std::size_t step = scattering(points.size());
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t i = k * step % points.size();
    points_.push_back({points[i], base[i], {}, {}});
  }
}

std::size_t RayProbe::samples() const {
  std::size_t fans = 0;
  for (const Point& point : points_) fans += point.drawn.fans.size() + point.without_floor.fans.size();
  return fans * kFan;
}

void RayProbe::trace(const ProbeSetting& setting, const std::vector<int>& more) {
  PathOptions options;
  options.bounces = setting.bounces;
  options.correction = true;
  PathOptions whole = options;
  whole.correction = false;
  const auto add = [&](const Transport& transport, std::size_t i, Light& light) {
    const RayPoint& from = points_[i].at;
    // As path_picture() has it.
    const bool hidden = transport.open_share(from.spot) < kMostlyHidden;
    const PointTransport at(transport, hidden ? whole : options, from.spot, from.to_viewer);
    light.certain = at.certain();
    light.sure = {at.sure(), {}, {}};
    if (hidden) light.sure.direct += -1.0 * points_[i].base;
    light.blocked = light.blocked || hidden || at.sure() != color::Rgb{};
    for (int k = 0; k < more[i] && !light.certain; ++k) {
      bool blocked = false;
      light.fans.push_back(at.batch_shares(mixed(mixed(setting.seed, i), light.fans.size()), 0, kFan, &blocked));
      light.blocked = light.blocked || blocked;
    }
  };
  constexpr std::size_t kTogether = 4;
  parallel_for(points_.size(), kTogether, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (more[i] == 0) continue;
      add(*setting.transport, i, points_[i].drawn);
      if (i < floor_points_) add(*setting.without_floor, i, points_[i].without_floor);
    }
  });
  blocked_ = 0;
  for (const Point& point : points_) blocked_ += point.drawn.blocked ? 1 : 0;
}

// A percentile is decided by the points about it: those get samples that may lie on either side of it, until the
// percentiles are sharp or the samples are spent.
void RayProbe::refine(const ProbeSetting& setting) {
  for (int round = 0; round < kMostRounds; ++round) {
    std::vector<double> wish(size(), 0);
    bool sharp = true;
    for (const Comparison& comparison : comparisons()) {
      if (count_for(comparison) == 0) continue;
      const std::vector<Change> all = changes(comparison);
      if (add_ambiguous(all, worth(all), wish)) sharp = false;
    }
    if (sharp) return;
    std::vector<std::size_t> order(size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return wish[a] > wish[b]; });
    int left = kMostInAll - static_cast<int>(samples() / kFan);
    std::vector<int> more(size(), 0);
    bool any = false;
    for (const std::size_t i : order) {
      const int has = fans(i);
      if (wish[i] == 0 || left <= 0) break;
      more[i] = std::clamp(std::max(has, kFirstFans), 0, std::min(left, kMostFans - has));
      left -= i < floor_points_ ? 2 * more[i] : more[i];
      any = any || more[i] > 0;
    }
    if (!any) return;
    trace(setting, more);
  }
}

// How much each of the points in doubt wishes for samples; whether there is any.
bool RayProbe::add_ambiguous(const std::vector<Change>& changes, const Worth& worth, std::vector<double>& wish) const {
  const double enough = std::max(kUnseen, kSharpPart * worth.de00_p95);
  // A point that rare bright paths have missed so far shows too small an error of its own: it has at least what
  // 19 of 20 points have.
  std::vector<double> errors;
  for (std::size_t i = 0; i < changes.size(); ++i)
    if (changes[i].standard_error > 0) errors.push_back(changes[i].standard_error * std::sqrt(fans(i)));
  double usual = 0;
  if (!errors.empty()) {
    const auto large = errors.begin() + static_cast<std::ptrdiff_t>(19 * errors.size() / 20);
    std::ranges::nth_element(errors, large);
    usual = *large;
  }
  bool any = false;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const Change& change = changes[i];
    if (fans(i) == 0 || fans(i) >= kMostFans) continue;
    const double error = std::max(change.standard_error, usual / std::sqrt(fans(i)));
    if (error <= 0.5 * enough || std::abs(change.de00 - worth.de00_p95) > kDoubt * error) continue;
    wish[i] = std::max(wish[i], error / enough);
    any = true;
  }
  return any;
}

color::Rgb RayProbe::added(std::size_t i, const RayEffects& effects) const {
  const Light& light = points_[i].drawn;
  return light.sure.shown(effects) + mean_of(light.fans, 0, 1).shown(effects);
}

// With n fans the expectation of the squared difference is d^2 + c/n + O(1/n^2), whatever the metric: c holds the
// variance and the curvature. Halves of the fans have twice the excess, which takes it off.
RayProbe::Change RayProbe::change(std::size_t i, const Comparison& comparison) const {
  const Point& point = points_[i];
  const Light& first = point.drawn;
  const Light& second = comparison.floor ? point.without_floor : point.drawn;
  if (!first.blocked && !second.blocked) return {};
  const auto squared = [&](std::size_t begin, std::size_t step) {
    LightShares a = mean_of(first.fans, begin, step), b = mean_of(second.fans, begin, step);
    a += first.sure, b += second.sure;
    const double d =
        seen_difference(point.base + a.shown(comparison.with), point.base + b.shown(comparison.without), white_);
    return d * d;
  };
  const double whole = squared(0, 1);
  const std::size_t count = first.fans.size();
  if (count < 2) return {std::sqrt(whole), 0};
  Estimates values;
  for (std::size_t k = 0; k < count; ++k) {
    const color::Rgb other = k < second.fans.size() ? second.fans[k].shown(comparison.without) : color::Rgb{};
    values.add(first.fans[k].shown(comparison.with) - other);
  }
  Covariance covariance = values.covariance();
  for (double& element : covariance) element /= static_cast<double>(count);
  const color::Rgb shown =
      point.base + first.sure.shown(comparison.with) + mean_of(first.fans, 0, 1).shown(comparison.with);
  return {std::sqrt(std::max(0.0, 2 * whole - 0.5 * (squared(0, 2) + squared(1, 2)))),
          noise_de00(shown, covariance, white_)};
}

std::size_t RayProbe::count_for(const Comparison& comparison) const {
  return comparison.floor ? floor_points_ : size();
}

std::vector<RayProbe::Change> RayProbe::changes(const Comparison& comparison) const {
  std::vector<Change> all(count_for(comparison));
  parallel_for(all.size(), 128, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) all[i] = change(i, comparison);
  });
  return all;
}

// The percentile's own error: of n points, drawn from N, the k-th in order lies between those that are one standard
// deviation away from it in the order. The choice of points moves the place with the variance n 0.95 0.05 (1 - n/N),
// and each point that noise may have put on the wrong side moves it with 1/4.
Worth RayProbe::worth(std::vector<Change> changes) const {
  if (changes.empty()) return {};
  std::ranges::sort(changes, {}, &Change::de00);
  const std::size_t n = changes.size(), k = place_of_percentile(n);
  const double worth = changes[k].de00;
  const auto in_doubt = static_cast<double>(std::ranges::count_if(changes, [&](const Change& change) {
    return change.standard_error > 0 && std::abs(change.de00 - worth) <= change.standard_error;
  }));
  const auto count = static_cast<double>(n);
  const double chosen = visible_points_ > 0 ? std::max(0.0, 1 - count / visible_points_) : 1;
  const double places = std::sqrt(0.95 * 0.05 * count * chosen + 0.25 * in_doubt);
  const auto spread = static_cast<std::size_t>(std::lround(places));
  return {worth, 0.5 * (changes[std::min(n - 1, k + spread)].de00 - changes[k - std::min(k, spread)].de00)};
}

Worth RayProbe::worth(const RayEffects& with, const RayEffects& without) const {
  return worth(changes({with, without, false}));
}

std::optional<Worth> RayProbe::floor_worth() const {
  if (floor_points_ == 0) return std::nullopt;
  return worth(changes({kAll, kAll, true}));
}

// As path_picture() shares out its samples.
RayCost RayProbe::cost_of(Light Point::*of, std::size_t count, const RayEffects& effects, double tolerance_de00,
                          double visible_points, int samples, const RayLimits& limits) const {
  RayCost cost;
  if (!effects.shadow || count == 0) return cost;
  constexpr double kFewest = 1;
  const double groups = std::ceil(samples / 4.0), tolerance = tolerance_de00 * std::sqrt(groups);
  std::vector<double> needed;
  std::size_t traced = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Light& light = points_[i].*of;
    traced += light.certain ? 0 : 1;
    Estimates values;
    for (const LightShares& fan : light.fans) values.add(fan.shown(effects));
    const color::Rgb shown = light.sure.shown(effects) + mean_of(light.fans, 0, 1).shown(effects);
    const double one = noise_de00(points_[i].base + shown, values.covariance(), white_) / tolerance;
    needed.push_back(light.certain ? 0 : one * one);
  }
  const auto n = static_cast<double>(count);
  const auto fans_of = [&](double most) {
    double fans = 0;
    for (std::size_t i = 0; i < count; ++i)
      fans += (points_[i].*of).certain ? 0 : std::clamp(std::ceil(needed[i]), kFewest, most);
    return fans;
  };
  const double wanted = std::max(kFewest, std::ceil(1.05 * percentile_95(needed)));
  double most = std::clamp(limits.of_point / (kFan * groups), kFewest, wanted);
  // What a limit of the whole picture leaves for the points that need most.
  const double in_all = limits.in_all / (kFan * groups) * n / visible_points;
  if (fans_of(most) > in_all) {
    double within = kFewest;
    while (most - within > 0.5) {
      const double middle = 0.5 * (within + most);
      (fans_of(middle) <= in_all ? within : most) = middle;
    }
    most = within;
  }
  const double fans = fans_of(most);
  cost.noise = std::sqrt(wanted / most);
  cost.traced_share = static_cast<double>(traced) / n;
  cost.samples = kFan * groups * fans / n;
  cost.most_samples = kFan * groups * most;
  const double of_fan_ms = effects.self || effects.bounce ? passed_ms_ : direct_ms_;
  cost.ms = visible_points * (groups * fans / n * of_fan_ms + samples * point_ms_);
  return cost;
}

RayCost RayProbe::cost(const RayEffects& effects, double tolerance_de00, double visible_points, int samples,
                       const RayLimits& limits) const {
  return cost_of(&Point::drawn, points_.size(), effects, tolerance_de00, visible_points, samples, limits);
}

RayCost RayProbe::cost_without_floor(const RayEffects& effects, double tolerance_de00, double visible_points,
                                     int samples, const RayLimits& limits) const {
  return cost_of(&Point::without_floor, floor_points_, effects, tolerance_de00, visible_points, samples, limits);
}

}  // namespace goniochrome::render
