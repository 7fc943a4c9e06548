#include "fit/basis_search.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "base/angles.h"
#include "base/parallel.h"
#include "brdf/lobe_model.h"
#include "fit/internal/basis_lm.h"
#include "fit/paint_fit.h"
#include "math/cosine_power.h"
#include "math/least_squares.h"

namespace goniochrome::fit {

namespace {

constexpr double kPolishGain = 1e-5;

// At the inner optimum x the residual's dependence on x drops out (envelope
// theorem: x_j is either stationary or held at 0), so d err^2 / d log E_j = 2/n
// sum w^2 r x_j E_j log(cos t) cos^E_j t.
SquaredError squared_error(const std::vector<double>& exponents, const BasisTarget& target, bool with_gradient) {
  const int lobes = static_cast<int>(exponents.size());
  const int rows = static_cast<int>(target.angles_deg.size());
  SquaredError result{0, std::vector<double>(with_gradient ? exponents.size() : 0, 0.0)};
  math::Matrix shape(rows, lobes);
  for (int j = 0; j < lobes; ++j)
    for (int r = 0; r < rows; ++r) shape(r, j) = math::cos_power(target.angles_deg[r] * kDegree, exponents[j]);

  std::size_t count = 0;
  for (int c = 0; c < 3; ++c) {
    math::Matrix m(rows, lobes + 1);
    std::vector<double> b(rows);
    for (int r = 0; r < rows; ++r) {
      const double w = target.weight[c][r];
      m(r, 0) = w;
      for (int j = 0; j < lobes; ++j) m(r, j + 1) = w * shape(r, j);
      b[r] = w * target.value[c][r];
    }
    const math::NonNegativeFit fit = math::nnls(m, b);
    for (int r = 0; r < rows; ++r) {
      double residual = -b[r];
      for (int j = 0; j <= lobes; ++j) residual += m(r, j) * fit.x[j];
      result.value += residual * residual;
      if (!with_gradient) continue;
      const double log_cos = std::log(std::max(std::cos(target.angles_deg[r] * kDegree), 1e-300));
      for (int j = 0; j < lobes; ++j)
        result.gradient[j] += 2 * residual * m(r, j + 1) * fit.x[j + 1] * exponents[j] * log_cos;
    }
    count += rows;
  }
  const double scale = 1.0 / static_cast<double>(std::max<std::size_t>(count, 1));
  result.value *= scale;
  for (double& g : result.gradient) g *= scale;
  return result;
}

}  // namespace

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

  // S_P = (mean err^P)^(1/P) + mean err, which tends to max + mean from below,
  // and its gradient by log E.
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
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
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

// Coordinate steps on the true objective, halved when none helps: what is left
// after the smooth search rounds off its corner.
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

// Where a search with m lobes begins: the best smaller set with a lobe in each
// of its widest gaps, regular spacing, random.
std::vector<std::vector<double>> starting_points(const std::vector<double>& smaller, int m, const Problem& problem,
                                                 const BasisSearchOptions& options) {
  std::vector<std::vector<double>> starts;
  if (!smaller.empty() && static_cast<int>(smaller.size()) == m - 1) {
    std::vector<double> fence = {problem.low};
    fence.insert(fence.end(), smaller.begin(), smaller.end());
    fence.push_back(problem.high);
    std::vector<std::size_t> gaps(fence.size() - 1);
    for (std::size_t i = 0; i < gaps.size(); ++i) gaps[i] = i;
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

// The sharpest lobe that some target sees. A sharper one, fitted, would have an absurd weight for what it gives the
// first angle alone.
double sharpest_seen(const std::vector<BasisTarget>& targets) {
  double first_deg = 90;
  for (const BasisTarget& target : targets) first_deg = std::min(first_deg, target.angles_deg.front());
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
        problem.evaluations += minimize_by_levenberg_marquardt(targets, problem.low, problem.high, deadline, x);
      double value = problem.objective(x);
      // Only a start that can still win is worth the polish.
      if (value < 1.1 * best_value) polish(problem, x, value);
      if (value < best_value) best = x, best_value = value;
    }
    // A lobe more can always be left unused, so the larger set is never worse.
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
