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
constexpr int kLeastInAll = 8192, kMostInAll = 32768;
// A point's fans are of so many independent sequences in turn: the longer one is, the more evenly it covers what the
// point sees.
constexpr std::uint32_t kSequences = 2;
constexpr int kMostRounds = 6;
// The noise of a point is small enough when it is within this part of the percentile, apart from what nobody sees.
constexpr double kSharpPart = 0.15, kUnseen = 0.03;
// A point may lie on either side of the percentile if it is no farther from it than so many standard errors.
constexpr double kDoubt = 2;
// Points that are traced once more without light that is passed on, for the time of that.
constexpr std::size_t kTimed = 64;

constexpr RayEffects kAllEffects{true, true, true};

constexpr RayEffects kNoSelf{true, false, true}, kNoBounce{true, true, false};

// Whether pictures of a mesh are the same with both.
bool alike(const RayEffects& a, const RayEffects& b) {
  return a.shadow == b.shadow && a.self == b.self && a.bounce == b.bounce;
}

std::size_t number_of(const RayEffects& effects) {
  return (effects.self ? 1 : 0) + (effects.bounce ? 2 : 0);
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
  for (const RayEffects& effects : {kAllEffects, kNoSelf, kNoBounce, RayEffects{true, false, false}})
    probe.needs_[number_of(effects)] = probe.needs(probe.drawn_, 1, effects);
  probe.needs_without_floor_ = probe.needs(probe.without_floor_, probe.floor_step_, kAllEffects);
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

std::size_t RayProbe::fans(std::size_t i) const {
  const bool twice = !without_floor_.empty() && i % floor_step_ == 0;
  return drawn_[i].fans.size() + (twice ? without_floor_[i / floor_step_].fans.size() : 0);
}

std::size_t RayProbe::samples() const {
  std::size_t sum = 0;
  for (std::size_t i = 0; i < size(); ++i) sum += fans(i);
  return sum * kFan;
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
    if (light.fans.empty()) light.hidden = transport.open_share(from.spot) < kMostlyHidden;
    const PointTransport at(transport, light.hidden ? whole : options, from.spot, from.to_viewer);
    light.certain = at.certain();
    light.sure = {at.sure(), {}, {}};
    if (light.hidden) light.sure.direct += -1.0 * base_[i];
    light.blocked = light.blocked || light.hidden || at.sure() != color::Rgb{};
    for (int k = 0; k < more[i] && !light.certain; ++k) {
      const std::size_t fan = light.fans.size();
      const Sequence sequence(mixed(mixed(setting.seed, i), fan % kSequences), kFan * kMostFans / kSequences);
      bool blocked = false;
      light.fans.push_back(at.shares_of(sequence, static_cast<std::uint32_t>(fan / kSequences * kFan), kFan, &blocked));
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
  tell_floor();
  blocked_ = static_cast<std::size_t>(std::ranges::count_if(drawn_, &SampledLight::blocked));
}

// Both draw the same random numbers, so that their difference has less noise than either, and it is told as light is:
// each told by points of its own that are alike, they would differ where they do not.
void RayProbe::tell_floor() {
  of_floor_.resize(without_floor_.size());
  for (std::size_t j = 0; j < of_floor_.size(); ++j) {
    const SampledLight &with = drawn_[j * floor_step_], &without = without_floor_[j];
    SampledLight& change = of_floor_[j];
    change.sure = with.sure;
    change.sure += -1.0 * without.sure;
    change.certain = with.certain && without.certain;
    change.hidden = with.hidden;
    change.fans.assign(std::max(with.fans.size(), without.fans.size()), {});
    for (std::size_t k = 0; k < with.fans.size(); ++k) change.fans[k] += with.fans[k];
    for (std::size_t k = 0; k < without.fans.size(); ++k) change.fans[k] += -1.0 * without.fans[k];
  }
  tell_lights(points_, floor_step_, of_floor_);
}

// A percentile is decided by the points about it: those get samples that may lie on either side of it, until their
// noise is small or the samples are spent. That the percentile seems to be known is no reason to stop sooner: the noise
// of all points together moves it to one side.
void RayProbe::refine(const ProbeSetting& setting) {
  // Where few points need rays at all, these get the more of them.
  for (int fans = kFirstFans; 2 * fans <= kMostFans && samples() < std::size_t{kLeastInAll} * kFan; fans *= 2)
    trace(setting, std::vector<int>(size(), fans));
  for (int round = 0; round < kMostRounds; ++round) {
    compare();
    const std::vector<std::size_t> noisy = in_doubt();
    const auto left = static_cast<double>(kMostInAll) - static_cast<double>(samples()) / kFan;
    double wanted = 0;
    for (const std::size_t i : noisy) wanted += static_cast<double>(fans(i));
    if (noisy.empty() || left <= 0) return;
    // Where that is too much, some of them, all over the picture.
    const double taken = std::min(1.0, left / wanted);
    std::vector<int> more(size(), 0);
    for (std::size_t k = 0; k < noisy.size(); ++k)
      if (std::floor((k + 1.0) * taken) > std::floor(static_cast<double>(k) * taken))
        more[noisy[k]] = static_cast<int>(drawn_[noisy[k]].fans.size());
    trace(setting, more);
  }
  compare();
}

// The points that may lie on either side of a percentile, and whose noise is too much to tell.
std::vector<std::size_t> RayProbe::in_doubt() const {
  std::vector<char> noisy(size(), 0);
  for (const Changes& all : compared_) {
    const std::size_t step = all.of.floor ? floor_step_ : 1;
    const double worth = all.worth.de00_p95;
    parallel_for(all.de00.size(), 128, [&](std::size_t begin, std::size_t end) {
      for (std::size_t j = begin; j < end; ++j) {
        const std::size_t i = j * step;
        const double away = std::abs(all.de00[j] - worth);
        if (drawn_[i].certain || 2 * drawn_[i].fans.size() > std::size_t{kMostFans} || away > worth + kUnseen) continue;
        const double error = noise(i, all.of);
        if (error > kSharpPart * worth + kUnseen && away <= kDoubt * error) noisy[i] = 1;
      }
    });
  }
  std::vector<std::size_t> points;
  for (std::size_t i = 0; i < size(); ++i)
    if (noisy[i] != 0) points.push_back(i);
  return points;
}

// The three comparisons that a plan makes, and that of the floor.
void RayProbe::compare() {
  compared_ = {changes({kAllEffects, {}}), changes({kAllEffects, kNoSelf}), changes({kAllEffects, kNoBounce})};
  if (!without_floor_.empty()) compared_.push_back(changes({kAllEffects, kAllEffects, true}));
}

double RayProbe::change(std::size_t i, const Comparison& comparison) const {
  const SampledLight& light = drawn_[i];
  const color::Rgb with = light.told.shown(comparison.with);
  color::Rgb without = light.told.shown(comparison.without);
  if (comparison.floor) {
    if (!light.blocked && !without_floor_[i / floor_step_].blocked) return 0;
    without += -1.0 * of_floor_[i / floor_step_].told.sum();
  } else if (!light.blocked) {
    return 0;
  }
  return seen_difference(base_[i] + with, base_[i] + without, white_);
}

double RayProbe::noise(std::size_t i, const Comparison& comparison) const {
  const Covariance noise = comparison.floor ? covariance(of_floor_[i / floor_step_], kAllEffects, {})
                                            : covariance(drawn_[i], comparison.with, comparison.without);
  return noise_de00(base_[i] + drawn_[i].told.shown(comparison.with), noise, white_);
}

// The percentile's own error: of n points, drawn from N, the k-th in order lies between those that are one standard
// deviation away from it in the order. The choice of points moves the place with the variance n 0.95 0.05 (1 - n/N),
// and each point that noise may have put on the wrong side moves it with 1/4.
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
  std::vector<char> doubted(n, 0);
  parallel_for(n, 128, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j) {
      const double away = std::abs(all.de00[j] - worth);
      doubted[j] = all.de00[j] > 0 && away <= 0.5 * worth + kUnseen && away <= noise(j * step, comparison) ? 1 : 0;
    }
  });
  const auto in_doubt = static_cast<double>(std::ranges::count(doubted, 1));
  const auto count = static_cast<double>(n);
  const double chosen = visible_points_ > 0 ? std::max(0.0, 1 - count / visible_points_) : 1;
  all.worth = {worth, half_width(std::sqrt(0.95 * 0.05 * count * chosen + 0.25 * in_doubt))};
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

// As path_picture() judges noise: a point's own variance counts by its freedom, that of the points that are alike as so
// many.
std::vector<double> RayProbe::needs(const Lights& lights, std::size_t step, const RayEffects& effects) const {
  constexpr double kOfAlike = 4;
  std::vector<Covariance> own(lights.size());
  parallel_for(lights.size(), 128, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Estimates values;
      for (const LightShares& fan : lights[i].fans) values.add(fan.shown(effects));
      own[i] = values.covariance();
    }
  });
  std::vector<double> needs(lights.size(), 0);
  parallel_for(lights.size(), 128, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const SampledLight& light = lights[i];
      if (light.certain) continue;
      const double freedom = static_cast<double>(light.fans.size()) - 1;
      Covariance of_fan{};
      for (std::size_t c = 0; c < of_fan.size(); ++c) {
        double alike = 0;
        for (std::uint32_t a = 0; a < light.alike_count; ++a) alike += own[light.alike[a]][c] / light.alike_count;
        of_fan[c] = (freedom * own[i][c] + kOfAlike * alike) / (freedom + kOfAlike);
      }
      const double noise = noise_de00(base_[i * step] + light.told.shown(effects), of_fan, white_);
      needs[i] = noise * noise;
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
  return cost_of(without_floor_, needs_without_floor_, kAllEffects, tolerance_de00, visible_points, samples, limits);
}

}  // namespace goniochrome::render
