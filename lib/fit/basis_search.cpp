#include "fit/basis_search.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <random>

#include "base/angles.h"
#include "base/clock.h"
#include "brdf/gloss.h"
#include "brdf/lobe_model.h"
#include "fit/ceres_options.h"
#include "fit/internal/basis_errors.h"
#include "fit/internal/flake_fit.h"
#include "fit/internal/target_rows.h"
#include "math/cosine_power.h"
#include "math/elementary.h"
#include "math/least_squares.h"

namespace goniochrome::fit {

namespace {

constexpr double kPolishGain = 1e-4;

double row_weight(const BasisTargetOptions& options, double lightness) {
  return options.perceptual_weights ? color::lightness_slope(lightness) : 1;
}

// The weight of a coat's shares of light at each view. A share F of white light comes on top of the base, whose
// reflectance factor is `base`, and a view counts by the part of a sphere's picture that is seen at it.
std::array<double, kCoatErrorViews_deg.size()> coat_weights(const BasisTargetOptions& options, const color::Rgb& base,
                                                            const color::Xyz& white) {
  std::array<double, kCoatErrorViews_deg.size()> weights{};
  double within = 0;
  for (std::size_t v = 0; v < weights.size(); ++v) {
    const double view_deg = kCoatErrorViews_deg[v];
    const double end_deg = v + 1 < weights.size() ? (view_deg + kCoatErrorViews_deg[v + 1]) / 2 : 90;
    const double area = math::sin(end_deg * kDegree) * math::sin(end_deg * kDegree);
    const double fresnel = brdf::fresnel_dielectric(math::cos(view_deg * kDegree), brdf::kCoatIndex);
    const color::Rgb shown = base + color::Rgb{fresnel, fresnel, fresnel};
    weights[v] = std::sqrt(area - within) * fresnel * row_weight(options, color::lab_from_rgb(shown, white).L);
    within = area;
  }
  return weights;
}

}  // namespace

Result<BasisTarget> basis_target(const paint::Paint& paint, const BasisTargetOptions& options) {
  GONIO_ASSIGN(const color::Xyz white, color::white_point(paint::condition_of(paint)));
  GONIO_ASSIGN(const double index, brdf::coat_index_of_paint(paint));
  GONIO_ASSIGN(const Target fitted, target_rows(paint, options.target, white, {}, index));

  BasisTarget target{.name = paint.name, .rows = {}};
  double importance = 0;
  for (const TargetRow& row : fitted.rows) {
    if (row.angle_deg < fitted.first_deg) continue;
    target.rows.push_back({row.angle_deg, row.reflectance_factor,
                           std::sqrt(row.importance) * row.passages * row_weight(options, row.lightness),
                           row.passages});
    importance += row.importance;
  }
  if (target.rows.size() < 2) return input_error("paint \"{}\" has one angle: a basis needs at least two", paint.name);
  std::ranges::sort(target.rows, {}, &BasisRow::angle_deg);
  const double mean_importance = importance / static_cast<double>(target.rows.size());
  for (BasisRow& row : target.rows) row.weight /= std::sqrt(mean_importance);
  GONIO_ASSIGN(target.coat, brdf::rough_coat_of(paint.gloss, brdf::mirror_index(index)));
  target.coat_weights = coat_weights(options, target.rows.back().passages * target.rows.back().value, white);
  return target;
}

Result<BasisTarget> basis_target(const BrdfTarget& brdf, const BasisTargetOptions& options) {
  constexpr double kStep_deg = 2.5, kLast_deg = 110, kSteepest_deg = 75;
  constexpr auto kBins = static_cast<std::size_t>((kLast_deg - kGlareAngle_deg) / kStep_deg);
  struct Bin {
    double count = 0, angle_deg = 0;
    color::Rgb sum;
  };
  std::vector<Bin> bins(kBins);
  for (const BrdfSample& sample : brdf.samples) {
    const double angle_deg = sample.aspecular_rad / kDegree;
    const double at = (angle_deg - kGlareAngle_deg) / kStep_deg;
    if (at < 0 || at >= static_cast<double>(kBins)) continue;
    if (std::max(sample.light_deg, sample.view_deg) > kSteepest_deg) continue;
    Bin& bin = bins[static_cast<std::size_t>(at)];
    ++bin.count, bin.angle_deg += angle_deg, bin.sum += sample.value;
  }
  GONIO_ASSIGN(const color::Xyz white, color::white_point({"D65", 2}));
  BasisTarget target{.name = brdf.paint.name, .rows = {}};
  for (const Bin& bin : bins) {
    if (bin.count == 0) continue;
    const color::Rgb mean = (1 / bin.count) * bin.sum;
    target.rows.push_back(
        {bin.angle_deg / bin.count, non_negative(mean), row_weight(options, color::lab_from_rgb(mean, white).L)});
  }
  if (target.rows.size() < 2)
    return input_error("{}: has directions at less than two aspecular angles: a basis needs more", target.name);
  return target;
}

double basis_de00(const std::vector<double>& exponents, const BasisTarget& target) {
  LinearProblem problem{math::Matrix(static_cast<int>(target.rows.size()), static_cast<int>(exponents.size()) + 1)};
  for (int r = 0; r < problem.rows(); ++r) {
    const BasisRow& row = target.rows[r];
    problem.shape(r, 0) = 1;
    for (std::size_t j = 0; j < exponents.size(); ++j)
      problem.shape(r, static_cast<int>(j) + 1) = math::cos_power(row.angle_deg * kDegree, exponents[j]);
    problem.weight.push_back(row.weight), problem.value.push_back(row.value);
  }
  const std::vector<color::Rgb> fitted = predictions(problem, linear_fit(Norm::kL2, problem).x);
  const color::Xyz white = *color::white_point({"D65", 2});
  double worst = 0;
  for (std::size_t r = 0; r < fitted.size(); ++r)
    worst = std::max(worst, color_difference(target.rows[r].passages * target.rows[r].value,
                                             target.rows[r].passages * fitted[r], white));
  return worst;
}

std::vector<SquaredError> squared_basis_errors(const std::vector<double>& exponents,
                                               const std::vector<BasisTarget>& targets, bool with_gradient) {
  return BasisErrors(targets).at(exponents, with_gradient);
}

namespace {

std::vector<double> exponents_of(const std::vector<double>& logs) {
  std::vector<double> exponents(logs.size());
  std::ranges::transform(logs, exponents.begin(), [](double x) { return std::exp(x); });
  return exponents;
}

BasisError error_of(const std::vector<SquaredError>& squares, const std::vector<double>& shares) {
  BasisError error;
  for (std::size_t i = 0; i < squares.size(); ++i) {
    error.each.push_back(std::sqrt(squares[i].value));
    error.max = std::max(error.max, error.each.back());
    error.mean += shares[i] * error.each.back();
  }
  return error;
}

std::vector<double> equal_shares(std::size_t count) {
  return std::vector<double>(count, 1 / static_cast<double>(count));
}

// The domain in log E, and how often the objective was asked for.
struct Problem {
  const BasisErrors& errors;
  const std::vector<double>& shares;  // of each target in the mean
  double low, high;
  const Deadline& deadline;
  int evaluations = 0;

  void clamp(std::vector<double>& logs) const {
    for (double& x : logs) x = std::clamp(x, low, high);
  }
  double objective(const std::vector<double>& logs) {
    ++evaluations;
    return error_of(errors.at(exponents_of(logs), false), shares).objective();
  }

  // S_P = (mean err^P)^(1/P) + mean err, which tends to max + mean from below, and its gradient by log E. In the first
  // mean all targets count alike, since it stands for the largest error.
  double smoothed(const std::vector<double>& logs, double power, std::vector<double>& gradient) {
    ++evaluations;
    const auto squares = errors.at(exponents_of(logs), true);
    const double n = static_cast<double>(squares.size());
    double largest = 0;
    for (const auto& e : squares) largest = std::max(largest, e.value);
    gradient.assign(logs.size(), 0);
    if (largest == 0) return 0;
    const double top = std::sqrt(largest);
    double powers = 0, mean = 0;
    for (std::size_t i = 0; i < squares.size(); ++i) {
      powers += std::pow(std::sqrt(squares[i].value) / top, power);
      mean += shares[i] * std::sqrt(squares[i].value);
    }
    const double mean_power = std::pow(powers / n, 1 / power);
    for (std::size_t i = 0; i < squares.size(); ++i) {
      const double error = std::sqrt(squares[i].value);
      if (error <= 1e-12 * top) continue;
      const double by_error = mean_power / powers * std::pow(error / top, power - 1) + shares[i];
      for (std::size_t j = 0; j < logs.size(); ++j) gradient[j] += by_error * squares[i].gradient[j] / (2 * error);
    }
    return top * mean_power + mean;
  }
};

double inner(const std::vector<double>& a, const std::vector<double>& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

// BFGS with backtracking on the box [low, high]^m.
void minimize_smoothed(Problem& problem, std::vector<double>& x, double power) {
  const std::size_t m = x.size();
  std::vector<double> inverse(m * m, 0.0), gradient;
  const auto reset = [&] {
    std::ranges::fill(inverse, 0.0);
    for (std::size_t i = 0; i < m; ++i) inverse[i * m + i] = 1;
  };
  reset();
  double value = problem.smoothed(x, power, gradient);
  for (int iteration = 0; iteration < 60 && !problem.deadline.passed(); ++iteration) {
    std::vector<double> step(m, 0.0);
    for (std::size_t i = 0; i < m; ++i)
      for (std::size_t j = 0; j < m; ++j) step[i] -= inverse[i * m + j] * gradient[j];
    if (inner(step, gradient) >= 0) {
      reset();
      for (std::size_t i = 0; i < m; ++i) step[i] = -gradient[i];
    }
    // No lobe moves by more than a factor e^1.5 at once.
    double longest = 0;
    for (const double s : step) longest = std::max(longest, std::abs(s));
    if (longest == 0) return;
    double t = iteration == 0 ? 0.3 / longest : std::min(1.0, 1.5 / longest);
    std::vector<double> next, next_gradient;
    double next_value = value;
    for (int halving = 0; halving < 12; ++halving, t *= 0.4) {
      next = x;
      for (std::size_t i = 0; i < m; ++i) next[i] += t * step[i];
      problem.clamp(next);
      next_value = problem.smoothed(next, power, next_gradient);
      if (next_value < value) break;
    }
    if (!(next_value < value)) return;
    std::vector<double> s(m), y(m);
    for (std::size_t i = 0; i < m; ++i) s[i] = next[i] - x[i], y[i] = next_gradient[i] - gradient[i];
    const double sy = inner(s, y);
    if (sy > 1e-14) {
      std::vector<double> hy(m, 0.0);
      for (std::size_t i = 0; i < m; ++i)
        for (std::size_t j = 0; j < m; ++j) hy[i] += inverse[i * m + j] * y[j];
      const double factor = (1 + inner(y, hy) / sy) / sy;
      for (std::size_t i = 0; i < m; ++i)
        for (std::size_t j = 0; j < m; ++j)
          inverse[i * m + j] += factor * s[i] * s[j] - (hy[i] * s[j] + s[i] * hy[j]) / sy;
    } else {
      reset();
    }
    const double gain = value - next_value;
    x = next, value = next_value, gradient = next_gradient;
    if (gain < 1e-7 * value) return;
  }
}

// The residuals of Levenberg and Marquardt's method: the RMS error of each target, with its derivative by log E, times
// the root of what the target counts where 1 is the mean.
class TargetErrors final : public ceres::CostFunction {
 public:
  TargetErrors(Problem& problem, std::size_t lobes) : problem_(problem) {
    set_num_residuals(static_cast<int>(problem.shares.size()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(lobes));
  }

  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override {
    ++problem_.evaluations;
    const auto lobes = static_cast<std::size_t>(parameter_block_sizes()[0]);
    const std::vector<double> exponents = exponents_of({parameters[0], parameters[0] + lobes});
    const bool with_gradient = jacobians && jacobians[0];
    const auto squares = problem_.errors.at(exponents, with_gradient);
    for (std::size_t i = 0; i < squares.size(); ++i) {
      const double error = std::sqrt(squares[i].value);
      const double counts = std::sqrt(problem_.shares[i] * static_cast<double>(squares.size()));
      residuals[i] = counts * error;
      if (!with_gradient) continue;
      for (std::size_t j = 0; j < lobes; ++j)
        jacobians[0][i * lobes + j] = error > 0 ? counts * squares[i].gradient[j] / (2 * error) : 0;
    }
    return true;
  }

 private:
  Problem& problem_;
};

// The source's choice: a local minimum of sum err^2 over the targets, on the box [low, high]^m. [Shimizu2009] 2.3.2
void minimize_by_levenberg_marquardt(Problem& search, std::vector<double>& logs) {
  ceres::Problem problem;
  problem.AddResidualBlock(new TargetErrors(search, logs.size()), nullptr, logs.data());
  for (std::size_t j = 0; j < logs.size(); ++j) {
    problem.SetParameterLowerBound(logs.data(), static_cast<int>(j), search.low);
    problem.SetParameterUpperBound(logs.data(), static_cast<int>(j), search.high);
  }
  ceres::Solver::Options options = quiet_solver_options();
  options.max_num_iterations = 100;
  if (search.deadline.limit_s() > 0) options.max_solver_time_in_seconds = std::max(0.01, search.deadline.left_s());
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
}

// Coordinate steps on the true objective, which shrink where none helps. The smooth searches round off the corner at
// which the largest error changes from one paint to another; these steps do not.
void polish(Problem& problem, std::vector<double>& x, double& value) {
  for (double step = 0.08; step > 2e-3 && !problem.deadline.passed();) {
    bool moved = false;
    for (std::size_t j = 0; j < x.size(); ++j)
      for (const double direction : {step, -step}) {
        std::vector<double> next = x;
        next[j] += direction;
        problem.clamp(next);
        const double next_value = problem.objective(next);
        if (next_value < value * (1 - kPolishGain)) {
          x = next, value = next_value, moved = true;
          break;
        }
      }
    if (!moved) step *= 0.4;
  }
}

// Where a search with m lobes begins: at the best smaller set with a lobe in each of its widest gaps, at regular
// spacing, and at random.
std::vector<std::vector<double>> starting_points(const std::vector<double>& smaller, int m, const Problem& problem,
                                                 const BasisSearchOptions& options) {
  std::vector<std::vector<double>> starts;
  if (!smaller.empty() && static_cast<int>(smaller.size()) == m - 1) {
    std::vector<double> fence = {problem.low};
    fence.insert(fence.end(), smaller.begin(), smaller.end());
    fence.push_back(problem.high);
    std::vector<std::size_t> gaps(fence.size() - 1);
    std::iota(gaps.begin(), gaps.end(), std::size_t{0});
    std::ranges::stable_sort(gaps, std::greater<>{}, [&](std::size_t i) { return fence[i + 1] - fence[i]; });
    for (std::size_t i = 0; i < gaps.size() && static_cast<int>(starts.size()) < std::max(1, options.starts / 2); ++i) {
      std::vector<double> start = smaller;
      start.push_back(0.5 * (fence[gaps[i]] + fence[gaps[i] + 1]));
      starts.push_back(start);
    }
  }
  std::vector<double> regular(static_cast<std::size_t>(m));
  for (int j = 0; j < m; ++j) regular[j] = problem.low + (problem.high - problem.low) * (j + 0.5) / m;
  starts.push_back(regular);
  std::mt19937_64 random(options.seed * 1000003 + static_cast<std::uint64_t>(m));
  while (static_cast<int>(starts.size()) < options.starts) {
    std::vector<double> start(static_cast<std::size_t>(m));
    for (double& x : start)
      x = problem.low + (problem.high - problem.low) * (static_cast<double>(random() >> 11) * 0x1p-53);
    starts.push_back(start);
  }
  starts.resize(std::min<std::size_t>(starts.size(), static_cast<std::size_t>(std::max(1, options.starts))));
  for (auto& start : starts) std::ranges::sort(start);
  return starts;
}

// The sharpest lobe that some target sees; a coat sees all. A sharper one would be fitted to the first angle alone,
// with a weight that means nothing anywhere else.
double sharpest_seen(const std::vector<BasisTarget>& targets) {
  double first_deg = 90;
  if (std::ranges::any_of(targets, [](const BasisTarget& target) { return target.coat.has_value(); }))
    return std::numeric_limits<double>::infinity();
  for (const BasisTarget& target : targets) first_deg = std::min(first_deg, target.rows.front().angle_deg);
  return std::log(kSeenPart) / math::log_cosine(first_deg * kDegree);
}

// The exponents of a domain, [low, high] in log E, that are regular in log space.
std::vector<double> regular_exponents(double low, double high, int count) {
  std::vector<double> exponents;
  for (int j = 0; j < count; ++j) exponents.push_back(std::exp(low + (high - low) * (j + 0.5) / count));
  return exponents;
}

}  // namespace

void set_floors(std::vector<BasisTarget>& targets) {
  constexpr int kDense = 32;
  const BasisSearchOptions domain;
  for (BasisTarget& target : targets) target.floor = 0;
  const double high = std::max(2 * domain.low, std::min(domain.high, sharpest_seen(targets)));
  std::vector<double> dense = regular_exponents(std::log(domain.low), std::log(high), kDense);
  dense.insert(dense.begin(), domain.low), dense.push_back(high);
  const std::vector<SquaredError> errors = squared_basis_errors(dense, targets, false);
  for (std::size_t i = 0; i < targets.size(); ++i) targets[i].floor = std::sqrt(errors[i].value);
}

double basis_error(const std::vector<double>& exponents, const BasisTarget& target) {
  return basis_error(exponents, std::vector{target}).max;
}

BasisError basis_error(const std::vector<double>& exponents, const std::vector<BasisTarget>& targets) {
  return error_of(squared_basis_errors(exponents, targets, false), equal_shares(targets.size()));
}

namespace {

// The targets that a search looks at: all of them, or some that stand for all. Every target of a sorted list stands for
// itself and its neighbors, which have nearly the same error with a basis that is regular in log space. These keep the
// mean; the largest error is kept by those that join.
class Chosen {
 public:
  Chosen(const std::vector<BasisTarget>& all, std::size_t wanted, double low, double high)
      : all_(all), is_in_(all.size()) {
    if (wanted == 0 || all.size() <= 2 * wanted) {
      shares_ = equal_shares(all.size());
      errors_.emplace(all);
      return;
    }
    const std::vector<double> each = basis_error(regular_exponents(low, high, 5), all).each;
    std::vector<std::size_t> order(all.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return each[i]; });
    for (std::size_t k = 0; k < wanted; ++k) {
      const std::size_t begin = k * order.size() / wanted, end = (k + 1) * order.size() / wanted;
      take(order[(begin + end) / 2], static_cast<double>(end - begin) / static_cast<double>(order.size()));
    }
    errors_.emplace(part_);
  }

  bool are_all() const { return part_.empty(); }
  std::size_t size() const { return shares_.size(); }
  const BasisErrors& errors() const { return *errors_; }
  const std::vector<double>& shares() const { return shares_; }

  // Lets the worst of those targets join whose error is beyond `bound`. Returns whether there was one.
  bool join(const std::vector<double>& each, double bound) {
    constexpr std::size_t kAtOnce = 8;
    std::vector<std::size_t> beyond;
    for (std::size_t i = 0; i < each.size(); ++i)
      if (each[i] > bound && !is_in_[i]) beyond.push_back(i);
    std::ranges::stable_sort(beyond, std::greater<>(), [&](std::size_t i) { return each[i]; });
    beyond.resize(std::min(beyond.size(), kAtOnce));
    for (const std::size_t i : beyond) take(i, 0);
    if (!beyond.empty()) errors_.emplace(part_);
    return !beyond.empty();
  }

 private:
  void take(std::size_t i, double share) { part_.push_back(all_[i]), shares_.push_back(share), is_in_[i] = true; }

  const std::vector<BasisTarget>& all_;
  std::vector<bool> is_in_;
  std::vector<BasisTarget> part_;
  std::vector<double> shares_;
  std::optional<BasisErrors> errors_;
};

// A set that was found for one number of lobes, as logarithms.
struct Best {
  std::vector<double> logs;
  double value = std::numeric_limits<double>::infinity();
};

// Descends from x, and keeps what it comes to where that is better.
void try_start(Problem& problem, BasisMethod method, std::vector<double> x, Best& best) {
  if (method == BasisMethod::kPowerMean)
    for (const double power : {4.0, 12.0, 40.0}) minimize_smoothed(problem, x, power);
  else
    minimize_by_levenberg_marquardt(problem, x);
  double value = problem.objective(x);
  // A start that is far behind the best one cannot win by the polish.
  if (value < 1.1 * best.value) polish(problem, x, value);
  if (value < best.value) best = {x, value};
}

// The search over the numbers of lobes, one after the other.
class Search {
 public:
  Search(const std::vector<BasisTarget>& targets, const BasisSearchOptions& options)
      : targets_(targets),
        options_(options),
        deadline_(options.time_limit_s),
        low_(std::log(options.low)),
        high_(std::log(std::max(2 * options.low, std::min(options.high, sharpest_seen(targets))))),
        chosen_(targets, options.representatives, low_, high_) {}

  BasisSearch all() {
    for (int m = options_.first; m <= options_.last; ++m) {
      add_set(m);
      if (!deadline_.passed()) continue;
      search_.stopped = m < options_.last;
      break;
    }
    return std::move(search_);
  }

 private:
  Problem problem() const { return {chosen_.errors(), chosen_.shares(), low_, high_, deadline_}; }

  void add_set(int m) {
    const Stopwatch clock;
    Problem first = problem();
    const auto starts = starting_points(smaller_, m, first, options_);
    Best best;
    for (const std::vector<double>& x : starts) {
      if (deadline_.passed() && !best.logs.empty()) break;
      try_start(first, options_.method, x, best);
    }
    int evaluations = first.evaluations;
    BasisError error = basis_error(exponents_of(best.logs), targets_);
    if (!chosen_.are_all()) meet_all(best, error, evaluations);
    // Where no start is as good as the smaller set, that set with one more lobe is, for a lobe can be left unused.
    if (!smaller_.empty() && error.objective() > search_.sets.back().error.objective()) {
      Problem again = problem();
      Best longer{starting_points(smaller_, m, again, options_).front()};
      const std::vector<double> unpolished = longer.logs;
      longer.value = again.objective(longer.logs);
      polish(again, longer.logs, longer.value);
      evaluations += again.evaluations;
      best = longer, error = basis_error(exponents_of(best.logs), targets_);
      if (error.objective() > search_.sets.back().error.objective())
        best.logs = unpolished, error = basis_error(exponents_of(best.logs), targets_);
    }
    std::ranges::sort(best.logs);
    smaller_ = best.logs;
    constexpr double kAtBound = 1e-3;
    search_.sets.push_back({.exponents = exponents_of(best.logs),
                            .error = std::move(error),
                            .starts = static_cast<int>(starts.size()),
                            .evaluations = evaluations,
                            .looked_at = static_cast<int>(chosen_.size()),
                            .at_low = best.logs.front() < low_ + kAtBound,
                            .at_high = best.logs.back() > high_ - kAtBound,
                            .time_s = clock.elapsed_s()});
  }

  // A search on some of the targets: the worst of the others join until none has a larger error than these, and the
  // search goes on from where it was.
  void meet_all(Best& best, BasisError& error, int& evaluations) {
    constexpr double kBeyond = 1e-3;
    constexpr int kRounds = 12;
    std::vector<double> least = best.logs;
    for (int round = 0; round < kRounds && !deadline_.passed(); ++round) {
      const double bound = error_of(chosen_.errors().at(exponents_of(best.logs), false), chosen_.shares()).max;
      const std::vector<double> each = round == 0 ? error.each : basis_error(exponents_of(best.logs), targets_).each;
      if (!chosen_.join(each, (1 + kBeyond) * bound)) break;
      Problem joined = problem();
      best.value = joined.objective(best.logs);
      try_start(joined, options_.method, best.logs, best);
      evaluations += joined.evaluations;
      BasisError next = basis_error(exponents_of(best.logs), targets_);
      if (next.objective() < error.objective()) least = best.logs, error = std::move(next);
    }
    best.logs = least;
  }

  const std::vector<BasisTarget>& targets_;
  const BasisSearchOptions& options_;
  Deadline deadline_;
  double low_, high_;
  Chosen chosen_;
  BasisSearch search_;
  std::vector<double> smaller_;
};

}  // namespace

BasisSearch search_basis(const std::vector<BasisTarget>& targets, const BasisSearchOptions& options) {
  return Search(targets, options).all();
}

}  // namespace goniochrome::fit
