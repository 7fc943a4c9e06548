#include "fit/basis_search.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <random>

#include "base/angles.h"
#include "base/clock.h"
#include "base/parallel.h"
#include "brdf/gloss.h"
#include "brdf/lobe_model.h"
#include "fit/ceres_options.h"
#include "fit/internal/flake_fit.h"
#include "math/cosine_power.h"
#include "math/least_squares.h"

namespace goniochrome::fit {

namespace {

constexpr double kPolishGain = 1e-5;

double row_weight(const BasisTargetOptions& options, double lightness) {
  return options.perceptual_weights ? color::lightness_slope(lightness) : 1;
}

// Adds the mean square error of the coat of a target. Of a lobe of energy 1 the share 1 - cos^(E+1) psi lies within
// psi, whose derivative by log E is -E log(cos psi) cos^(E+1) psi.
void add_coat_error(const std::vector<double>& exponents, const BasisTarget& target, bool with_gradient,
                    SquaredError& result) {
  static constexpr std::size_t kViews[] = {1, 3, 5, 8, 11};  // 20, 45, 60, 75, 85 deg
  const std::span<const double> rings = brdf::ring_angles_rad();
  const int rows = static_cast<int>(rings.size()), lobes = static_cast<int>(exponents.size());
  math::Matrix m(rows, lobes + (target.mirror ? 1 : 0));
  for (int k = 0; k < rows; ++k) {
    for (int j = 0; j < lobes; ++j) m(k, j) = 1 - math::cos_power(rings[k], exponents[j] + 1);
    if (target.mirror) m(k, lobes) = 1;
  }
  for (const std::size_t view : kViews) {
    const double weight =
        target.coat_weight * brdf::fresnel_dielectric(std::cos(brdf::kCoatViews_deg[view] * kDegree), brdf::kCoatIndex);
    const double scale = weight * weight / (static_cast<double>(std::size(kViews)) * rows);
    const std::vector<double> wanted = brdf::coat_within(*target.coat, view);
    const math::NonNegativeFit fit = math::nnls(m, wanted);
    for (int k = 0; k < rows; ++k) {
      double residual = -wanted[k];
      for (int j = 0; j < m.columns; ++j) residual += m(k, j) * fit.x[j];
      result.value += scale * residual * residual;
      const double log_cos = math::log_cosine(rings[k]);
      if (!with_gradient || std::isinf(log_cos)) continue;
      for (int j = 0; j < lobes; ++j)
        result.gradient[j] -= 2 * scale * residual * fit.x[j] * exponents[j] * log_cos * (1 - m(k, j));
    }
  }
}

// At the inner optimum x the residual's dependence on x drops out (envelope theorem: x_j is either stationary or held
// at 0), so d err^2 / d log E_j = 2/n sum w^2 r x_j E_j log(cos t) cos^E_j t.
SquaredError squared_error(const std::vector<double>& exponents, const BasisTarget& target, bool with_gradient) {
  const int lobes = static_cast<int>(exponents.size());
  const int rows = static_cast<int>(target.rows.size());
  SquaredError result{0, std::vector<double>(with_gradient ? exponents.size() : 0, 0.0)};
  // The weighted constant and lobes are the same for all channels.
  math::Matrix m(rows, lobes + 1);
  for (int r = 0; r < rows; ++r) m(r, 0) = target.rows[r].weight;
  for (int j = 0; j < lobes; ++j)
    for (int r = 0; r < rows; ++r)
      m(r, j + 1) = target.rows[r].weight * math::cos_power(target.rows[r].angle_deg * kDegree, exponents[j]);

  std::vector<double> b(rows);
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < rows; ++r) b[r] = target.rows[r].weight * target.rows[r].value[c];
    const math::NonNegativeFit fit = math::nnls(m, b);
    for (int r = 0; r < rows; ++r) {
      double residual = -b[r];
      for (int j = 0; j <= lobes; ++j) residual += m(r, j) * fit.x[j];
      result.value += residual * residual;
      if (!with_gradient) continue;
      const double log_cos = std::log(std::max(std::cos(target.rows[r].angle_deg * kDegree), 1e-300));
      for (int j = 0; j < lobes; ++j)
        result.gradient[j] += 2 * residual * m(r, j + 1) * fit.x[j + 1] * exponents[j] * log_cos;
    }
  }
  const double scale = 1.0 / std::max(3 * rows, 1);
  result.value *= scale;
  for (double& g : result.gradient) g *= scale;
  if (target.coat) add_coat_error(exponents, target, with_gradient, result);
  return result;
}

}  // namespace

Result<BasisTarget> basis_target(const paint::Paint& paint, const BasisTargetOptions& options) {
  GONIO_ASSIGN(const paint::TargetCurve curve, paint::TargetCurve::make(paint, options.target));
  GONIO_ASSIGN(const color::Xyz white, color::white_point(paint::condition_of(paint)));
  const auto& known = curve.known_angles_deg();
  const double first = std::max(known.front(), kGlareAngle_deg), last = std::min(known.back(), 110.0);
  if (last <= first) return input_error("paint \"{}\" has one angle: a basis needs at least two", paint.name);

  BasisTarget target{.name = paint.name, .rows = {}};
  for (int i = 0; i < options.angles; ++i) {
    const double angle = first + (last - first) * i / (options.angles - 1);
    const color::Lab lab = curve.at(angle);
    target.rows.push_back({angle, non_negative(color::rgb_from_lab(lab, white)), row_weight(options, lab.L)});
  }
  GONIO_ASSIGN(const double index, brdf::coat_index_of(paint.gloss));
  GONIO_ASSIGN(target.coat, brdf::rough_coat_of(paint.gloss, brdf::mirror_index(index)));
  target.coat_weight = target.rows.back().weight;
  target.mirror = options.mirror;
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
    worst = std::max(worst, color_difference(target.rows[r].value, fitted[r], white));
  return worst;
}

std::vector<SquaredError> squared_basis_errors(const std::vector<double>& exponents,
                                               const std::vector<BasisTarget>& targets, bool with_gradient) {
  std::vector<SquaredError> errors(targets.size());
  parallel_for(targets.size(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) errors[i] = squared_error(exponents, targets[i], with_gradient);
  });
  return errors;
}

namespace {

std::vector<double> exponents_of(const std::vector<double>& logs) {
  std::vector<double> exponents(logs.size());
  std::ranges::transform(logs, exponents.begin(), [](double x) { return std::exp(x); });
  return exponents;
}

// The domain in log E, and how often the objective was asked for.
struct Problem {
  const std::vector<BasisTarget>& targets;
  double low, high;
  const Deadline& deadline;
  int evaluations = 0;

  void clamp(std::vector<double>& logs) const {
    for (double& x : logs) x = std::clamp(x, low, high);
  }
  double objective(const std::vector<double>& logs) {
    ++evaluations;
    return basis_error(exponents_of(logs), targets).objective();
  }

  // S_P = (mean err^P)^(1/P) + mean err, which tends to max + mean from below, and its gradient by log E.
  double smoothed(const std::vector<double>& logs, double power, std::vector<double>& gradient) {
    ++evaluations;
    const auto errors = squared_basis_errors(exponents_of(logs), targets, true);
    const double n = static_cast<double>(errors.size());
    double largest = 0;
    for (const auto& e : errors) largest = std::max(largest, e.value);
    gradient.assign(logs.size(), 0);
    if (largest == 0) return 0;
    const double top = std::sqrt(largest);
    double powers = 0, sum = 0;
    for (const auto& e : errors) {
      powers += std::pow(std::sqrt(e.value) / top, power);
      sum += std::sqrt(e.value);
    }
    const double mean_power = std::pow(powers / n, 1 / power);
    for (const auto& e : errors) {
      const double error = std::sqrt(e.value);
      if (error <= 1e-12 * top) continue;
      const double by_error = mean_power / powers * std::pow(error / top, power - 1) + 1 / n;
      for (std::size_t j = 0; j < logs.size(); ++j) gradient[j] += by_error * e.gradient[j] / (2 * error);
    }
    return top * mean_power + sum / n;
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

// The residuals of Levenberg and Marquardt's method: the RMS error of each target, with its derivative by log E.
class TargetErrors final : public ceres::CostFunction {
 public:
  TargetErrors(const std::vector<BasisTarget>& targets, std::size_t lobes, int& evaluations)
      : targets_(targets), evaluations_(evaluations) {
    set_num_residuals(static_cast<int>(targets.size()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(lobes));
  }

  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override {
    ++evaluations_;
    const auto lobes = static_cast<std::size_t>(parameter_block_sizes()[0]);
    const std::vector<double> exponents = exponents_of({parameters[0], parameters[0] + lobes});
    const bool with_gradient = jacobians && jacobians[0];
    const auto errors = squared_basis_errors(exponents, targets_, with_gradient);
    for (std::size_t i = 0; i < errors.size(); ++i) {
      residuals[i] = std::sqrt(errors[i].value);
      if (!with_gradient) continue;
      for (std::size_t j = 0; j < lobes; ++j)
        jacobians[0][i * lobes + j] = residuals[i] > 0 ? errors[i].gradient[j] / (2 * residuals[i]) : 0;
    }
    return true;
  }

 private:
  const std::vector<BasisTarget>& targets_;
  int& evaluations_;
};

// The source's choice: a local minimum of sum err^2 over the targets, on the box [low, high]^m. [Shimizu2009] 2.3.2
void minimize_by_levenberg_marquardt(Problem& search, std::vector<double>& logs) {
  ceres::Problem problem;
  problem.AddResidualBlock(new TargetErrors(search.targets, logs.size(), search.evaluations), nullptr, logs.data());
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

}  // namespace

double basis_error(const std::vector<double>& exponents, const BasisTarget& target) {
  return std::sqrt(squared_error(exponents, target, false).value);
}

BasisError basis_error(const std::vector<double>& exponents, const std::vector<BasisTarget>& targets) {
  BasisError error;
  for (const SquaredError& e : squared_basis_errors(exponents, targets, false)) {
    error.each.push_back(std::sqrt(e.value));
    error.max = std::max(error.max, error.each.back());
    error.mean += error.each.back() / static_cast<double>(targets.size());
  }
  return error;
}

BasisSearch search_basis(const std::vector<BasisTarget>& targets, const BasisSearchOptions& options) {
  BasisSearch search;
  const double high = std::max(2 * options.low, std::min(options.high, sharpest_seen(targets)));
  const Deadline deadline(options.time_limit_s);
  std::vector<double> smaller;
  for (int m = options.first; m <= options.last; ++m) {
    const Stopwatch clock;
    Problem problem{targets, std::log(options.low), std::log(high), deadline};
    std::vector<double> best;
    double best_value = std::numeric_limits<double>::infinity();
    const auto starts = starting_points(smaller, m, problem, options);
    for (std::vector<double> x : starts) {
      if (deadline.passed() && !best.empty()) break;
      if (options.method == BasisMethod::kPowerMean)
        for (const double power : {4.0, 12.0, 40.0}) minimize_smoothed(problem, x, power);
      else
        minimize_by_levenberg_marquardt(problem, x);
      double value = problem.objective(x);
      // A start that is far behind the best one cannot win by the polish.
      if (value < 1.1 * best_value) polish(problem, x, value);
      if (value < best_value) best = x, best_value = value;
    }
    // Where no start is as good as the smaller set, that set with one more lobe is, for a lobe can be left unused.
    if (!smaller.empty() && best_value > search.sets.back().error.objective()) {
      best = starting_points(smaller, m, problem, options).front();
      best_value = problem.objective(best);
      polish(problem, best, best_value);
    }
    std::ranges::sort(best);
    smaller = best;
    const auto exponents = exponents_of(best);
    search.sets.push_back({exponents, basis_error(exponents, targets), static_cast<int>(starts.size()),
                           problem.evaluations, clock.elapsed_s()});
    if (deadline.passed()) {
      search.stopped = m < options.last;
      break;
    }
  }
  return search;
}

}  // namespace goniochrome::fit
