#include "materials/internal/nearest.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace goniochrome::materials {

namespace {

double sum_of_squares(const std::vector<double>& r) {
  double sum = 0;
  for (const double x : r) sum += x * x;
  return sum;
}

// The normal equations of the residuals at one place: A = J^T J, row by row, and g = J^T r.
struct Normal {
  std::vector<double> a, g;
};

// Solves (A + damping diag A) x = -g for the parameters that are free, by Cholesky's method; nothing where A is not
// positive definite. The others stay where they are.
std::optional<std::vector<double>> step_of(const Normal& normal, const std::vector<bool>& free, double damping) {
  const std::size_t n = normal.g.size();
  std::vector<double> l = normal.a, x(n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j)
      if (!free[i] || !free[j]) l[i * n + j] = i == j;
    if (free[i]) l[i * n + i] = l[i * n + i] * (1 + damping) + 1e-12;
  }
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = l[i * n + j];
      for (std::size_t k = 0; k < j; ++k) sum -= l[i * n + k] * l[j * n + k];
      if (i == j && !(sum > 0)) return std::nullopt;
      l[i * n + j] = i == j ? std::sqrt(sum) : sum / l[j * n + j];
    }
  for (std::size_t i = 0; i < n; ++i) {
    double sum = free[i] ? -normal.g[i] : 0;
    for (std::size_t k = 0; k < i; ++k) sum -= l[i * n + k] * x[k];
    x[i] = sum / l[i * n + i];
  }
  for (std::size_t i = n; i-- > 0;) {
    double sum = x[i];
    for (std::size_t k = i + 1; k < n; ++k) sum -= l[k * n + i] * x[k];
    x[i] = sum / l[i * n + i];
  }
  return x;
}

}  // namespace

double descend(std::vector<Parameter>& parameters,
               const std::function<void(const std::vector<Parameter>&, std::vector<double>&)>& residuals) {
  constexpr int kMostSteps = 60;
  constexpr double kDifference = 1e-5, kGain = 1e-5;  // of the range of a parameter; of the sum, to go on
  const std::size_t n = parameters.size();
  std::vector<double> at, beside;
  residuals(parameters, at);
  double best = sum_of_squares(at), damping = 1e-2;
  std::vector<std::vector<double>> columns(n);
  for (int step = 0; step < kMostSteps; ++step) {
    for (std::size_t i = 0; i < n; ++i) {
      std::vector<Parameter> moved = parameters;
      const double range = moved[i].high - moved[i].low;
      const double d =
          moved[i].value + kDifference * range > moved[i].high ? -kDifference * range : kDifference * range;
      moved[i].value += d;
      residuals(moved, beside);
      columns[i].resize(at.size());
      for (std::size_t k = 0; k < at.size(); ++k) columns[i][k] = (beside[k] - at[k]) / d;
    }
    Normal normal{std::vector<double>(n * n), std::vector<double>(n)};
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j)
        for (std::size_t k = 0; k < at.size(); ++k) normal.a[i * n + j] += columns[i][k] * columns[j][k];
      for (std::size_t k = 0; k < at.size(); ++k) normal.g[i] += columns[i][k] * at[k];
    }
    // A parameter at an end of its range, beyond which the sum would fall, stays there in this step.
    std::vector<bool> free(n);
    for (std::size_t i = 0; i < n; ++i) {
      const Parameter& p = parameters[i];
      free[i] = !(p.value <= p.low && normal.g[i] > 0) && !(p.value >= p.high && normal.g[i] < 0);
    }
    bool better = false;
    double gain = 0;
    for (int attempt = 0; attempt < 12 && !better; ++attempt, damping *= 4) {
      const auto x = step_of(normal, free, damping);
      if (!x) continue;
      std::vector<Parameter> moved = parameters;
      for (std::size_t i = 0; i < n; ++i)
        moved[i].value = std::clamp(moved[i].value + (*x)[i], moved[i].low, moved[i].high);
      residuals(moved, beside);
      const double sum = sum_of_squares(beside);
      if (!(sum < best)) continue;
      better = true;
      gain = best - sum;
      parameters = std::move(moved);
      at = beside;
      best = sum;
      damping /= 16;
    }
    if (!better || gain < kGain * best) break;
    damping = std::max(damping, 1e-9);
  }
  return best;
}

}  // namespace goniochrome::materials
