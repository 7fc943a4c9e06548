#include "render/plan/ray_probe.h"

#include <algorithm>
#include <cmath>

#include "base/clock.h"
#include "base/parallel.h"
#include "render/internal/seen.h"
#include "render/path/noise.h"
#include "render/path/path_tracer.h"

namespace goniochrome::render {

namespace {

// The fans of each point in the first round: two tell its noise.
constexpr int kFirstFans = 2;
// What the floor changes is told from so many points or more, if there are so many.
constexpr std::size_t kFloorPoints = 1024;
// No point gets more fans than that, and all points together no more than so many, and no fewer.
constexpr int kMostFans = 128;
constexpr int kLeastInAll = 8192, kMostInAll = 24576;
constexpr int kMostRounds = 6;
// A percentile is known well enough when noise makes no more than this part of it uncertain, or what nobody sees.
constexpr double kSharpPart = 0.07, kUnseen = 0.03;
// A point may lie on either side of the percentile if it is no farther from it than so many standard errors.
constexpr double kDoubt = 2;
// Points that are traced once more without light that is passed on, for the time of that.
constexpr std::size_t kTimed = 64;

constexpr RayEffects kAll{true, true, true};

constexpr RayEffects kNoSelf{true, false, true}, kNoBounce{true, true, false};

// Whether pictures of a mesh are the same with both.
bool alike(const RayEffects& a, const RayEffects& b) {
  return a.shadow == b.shadow && a.self == b.self && a.bounce == b.bounce;
}

std::size_t number_of(const RayEffects& effects) {
  return (effects.self ? 1 : 0) + (effects.bounce ? 2 : 0);
}

double trace_of(const Covariance& c) {
  return c[0] + c[1] + c[2];
}

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

RayProbe RayProbe::traced(const ProbeSetting& setting, const std::vector<RayPoint>& points,
                          const std::vector<color::Rgb>& base) {
  RayProbe probe;
  probe.white_ = setting.white_luminance > 0 ? setting.white_luminance : 1;
  probe.visible_points_ = setting.visible_points;
  if (points.empty()) return probe;
  probe.points_ = points, probe.base_ = base;
  probe.drawn_.resize(points.size());
  probe.floor_step_ = std::max<std::size_t>(1, points.size() / kFloorPoints);
  if (setting.without_floor != nullptr)
    probe.without_floor_.resize((points.size() + probe.floor_step_ - 1) / probe.floor_step_);
  const Stopwatch clock;
  probe.trace(setting, std::vector<int>(points.size(), kFirstFans));
  const double first_round_ms = 1000 * clock.elapsed_s();
  if (probe.free() && probe.without_floor_.empty()) return probe;
  probe.refine(setting);
  for (const RayEffects& effects : {kAll, kNoSelf, kNoBounce, RayEffects{true, false, false}})
    probe.needs_[number_of(effects)] = probe.needs(probe.drawn_, 1, effects);
  probe.needs_without_floor_ = probe.needs(probe.without_floor_, probe.floor_step_, kAll);
  probe.time(setting, first_round_ms / static_cast<double>(probe.size() + probe.without_floor_.size()));
  return probe;
}

// What the first round took is that of its points and of their fans. A few points are traced twice more without light
// that is passed on, in few fans and in many, which tells one from the other.
void RayProbe::time(const ProbeSetting& setting, double of_point_ms) {
  constexpr int kFew = 2, kMany = 10;
  RayProbe plain;
  const std::size_t step = (size() + kTimed - 1) / kTimed;
  for (std::size_t i = 0; i < size(); i += step) plain.points_.push_back(points_[i]), plain.base_.push_back(base_[i]);
  plain.drawn_.resize(plain.size());
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

std::size_t RayProbe::samples() const {
  std::size_t fans = 0;
  for (const SampledLight& light : drawn_) fans += light.fans.size();
  for (const SampledLight& light : without_floor_) fans += light.fans.size();
  return fans * kFan;
}

void RayProbe::trace(const ProbeSetting& setting, const std::vector<int>& more) {
  PathOptions options;
  options.bounces = setting.bounces;
  options.correction = true;
  PathOptions whole = options;
  whole.correction = false;
  const auto add = [&](const Transport& transport, std::size_t i, SampledLight& light) {
    const RayPoint& from = points_[i];
    // As path_picture() has it.
    light.hidden = transport.open_share(from.spot) < kMostlyHidden;
    const PointTransport at(transport, light.hidden ? whole : options, from.spot, from.to_viewer);
    light.certain = at.certain();
    light.sure = {at.sure(), {}, {}};
    if (light.hidden) light.sure.direct += -1.0 * base_[i];
    light.blocked = light.blocked || light.hidden || at.sure() != color::Rgb{};
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
      add(*setting.transport, i, drawn_[i]);
      if (i % floor_step_ == 0 && !without_floor_.empty())
        add(*setting.without_floor, i, without_floor_[i / floor_step_]);
    }
  });
  tell_lights(points_, 1, drawn_);
  tell_lights(points_, floor_step_, without_floor_);
  blocked_ = static_cast<std::size_t>(std::ranges::count_if(drawn_, &SampledLight::blocked));
}

// A percentile is decided by the points about it: those get samples that may lie on either side of it, until the
// percentiles are sharp or the samples are spent.
void RayProbe::refine(const ProbeSetting& setting) {
  // Where few points need rays at all, these get the more of them.
  for (int fans = kFirstFans; 2 * fans <= kMostFans && samples() < std::size_t{kLeastInAll} * kFan; fans *= 2)
    trace(setting, std::vector<int>(size(), fans));
  for (int round = 0;; ++round) {
    compare();
    std::vector<int> more(size(), 0);
    int left = round < kMostRounds ? kMostInAll - static_cast<int>(samples() / kFan) : 0;
    bool any = false;
    for (const Changes& all : compared_) {
      if (all.of_noise <= std::max(kUnseen, kSharpPart * all.worth.de00_p95)) continue;
      const std::size_t step = all.of.floor ? floor_step_ : 1;
      for (std::size_t j = 0; j < all.de00.size() && left > 0; ++j) {
        const std::size_t i = j * step;
        const int has = static_cast<int>(drawn_[i].fans.size());
        if (more[i] > 0 || drawn_[i].certain || 2 * has > kMostFans) continue;
        const double away = std::abs(all.de00[j] - all.worth.de00_p95);
        if (away > all.worth.de00_p95 + kUnseen || away > kDoubt * noise(i, all.of)) continue;
        more[i] = has, left -= has, any = true;
      }
    }
    if (!any) return;
    trace(setting, more);
  }
}

// The three comparisons that a plan makes, and that of the floor.
void RayProbe::compare() {
  compared_ = {changes({kAll, {}}), changes({kAll, kNoSelf}), changes({kAll, kNoBounce})};
  if (!without_floor_.empty()) compared_.push_back(changes({kAll, kAll, true}));
}

const SampledLight& RayProbe::second(std::size_t point, const Comparison& comparison) const {
  return comparison.floor ? without_floor_[point / floor_step_] : drawn_[point];
}

double RayProbe::change(std::size_t i, const Comparison& comparison) const {
  const SampledLight &one = drawn_[i], &other = second(i, comparison);
  if (!one.blocked && !other.blocked) return 0;
  return seen_difference(base_[i] + one.told.shown(comparison.with), base_[i] + other.told.shown(comparison.without),
                         white_);
}

Covariance RayProbe::doubt(std::size_t i, const Comparison& comparison, NoiseOf noise) const {
  if (!comparison.floor) return covariance(drawn_[i], comparison.with, comparison.without, noise);
  Covariance sum = covariance(drawn_[i], comparison.with, {}, noise);
  const Covariance other = covariance(second(i, comparison), comparison.without, {}, noise);
  for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += other[c];
  return sum;
}

double RayProbe::noise(std::size_t i, const Comparison& comparison) const {
  return noise_de00(base_[i] + drawn_[i].told.shown(comparison.with), doubt(i, comparison, NoiseOf::kTold), white_);
}

// The percentile's own error: of n points, drawn from N, the k-th in order lies between those that are one standard
// deviation away from it in the order. The choice of points moves the place with the variance n 0.95 0.05 (1 - n/N),
// and each point that noise may have put on the wrong side moves it with 1/4, together with those that share its noise.
RayProbe::Changes RayProbe::changes(const Comparison& comparison) const {
  const std::size_t step = comparison.floor ? floor_step_ : 1;
  Changes all;
  all.of = comparison;
  all.de00.resize(comparison.floor ? without_floor_.size() : size());
  if (all.de00.empty()) return all;
  parallel_for(all.de00.size(), 128, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j) all.de00[j] = change(j * step, comparison);
  });
  std::vector<double> sorted = all.de00;
  std::ranges::sort(sorted);
  const std::size_t n = sorted.size(), k = place_of_percentile(n);
  const double worth = sorted[k];
  const auto half_width = [&](double places) {
    const auto spread = static_cast<std::size_t>(std::lround(places));
    return 0.5 * (sorted[std::min(n - 1, k + spread)] - sorted[k - std::min(k, spread)]);
  };
  std::vector<double> doubts(n, 0);
  parallel_for(n, 128, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j) {
      const double away = std::abs(all.de00[j] - worth);
      if (all.de00[j] == 0 || away > 0.5 * worth + kUnseen || away > noise(j * step, comparison)) continue;
      const double own = trace_of(doubt(j * step, comparison, NoiseOf::kOwn)),
                   told = trace_of(doubt(j * step, comparison, NoiseOf::kTold));
      doubts[j] = told > 0 ? 0.25 * own / told : 0;
    }
  });
  double in_doubt = 0;
  for (const double one : doubts) in_doubt += one;
  const auto count = static_cast<double>(n);
  const double chosen = visible_points_ > 0 ? std::max(0.0, 1 - count / visible_points_) : 1;
  all.worth = {worth, half_width(std::sqrt(0.95 * 0.05 * count * chosen + in_doubt))};
  all.of_noise = half_width(std::sqrt(in_doubt));
  return all;
}

Worth RayProbe::worth(const RayEffects& with, const RayEffects& without) const {
  for (const Changes& known : compared_)
    if (!known.of.floor && alike(known.of.with, with) && alike(known.of.without, without)) return known.worth;
  return changes({with, without, false}).worth;
}

std::optional<Worth> RayProbe::floor_worth() const {
  if (without_floor_.empty()) return std::nullopt;
  return compared_.back().worth;
}

std::vector<double> RayProbe::needs(const Lights& lights, std::size_t step, const RayEffects& effects) const {
  std::vector<double> needs(lights.size(), 0);
  parallel_for(lights.size(), 128, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (lights[i].certain) continue;
      const color::Rgb shown = base_[i * step] + lights[i].told.shown(effects);
      const double noise = noise_de00(shown, covariance(lights[i], effects, {}, NoiseOf::kOwn), white_);
      needs[i] = noise * noise * static_cast<double>(lights[i].fans.size());
    }
  });
  return needs;
}

// As path_picture() shares out its samples.
RayCost RayProbe::cost_of(const Lights& lights, const std::vector<double>& needs, const RayEffects& effects,
                          double tolerance_de00, double visible_points, int samples, const RayLimits& limits) const {
  RayCost cost;
  if (!effects.shadow || lights.empty()) return cost;
  constexpr double kFewest = 1;
  const double groups = std::ceil(samples / 4.0), tolerance = tolerance_de00 * std::sqrt(groups);
  std::vector<double> needed;
  for (const double need : needs) needed.push_back(need / (tolerance * tolerance));
  const auto traced = std::ranges::count(lights, false, &SampledLight::certain);
  const auto n = static_cast<double>(lights.size());
  const auto fans_of = [&](double most) {
    double fans = 0;
    for (std::size_t i = 0; i < lights.size(); ++i)
      fans += lights[i].certain ? 0 : std::clamp(std::ceil(needed[i]), kFewest, most);
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
  return cost_of(drawn_, needs_[number_of(effects)], effects, tolerance_de00, visible_points, samples, limits);
}

RayCost RayProbe::cost_without_floor(double tolerance_de00, double visible_points, int samples,
                                     const RayLimits& limits) const {
  return cost_of(without_floor_, needs_without_floor_, kAll, tolerance_de00, visible_points, samples, limits);
}

}  // namespace goniochrome::render
