#include "fit/internal/linear_fit.h"

#include <algorithm>
#include <cmath>

namespace goniochrome::fit {

LinearFit linear_fit(Norm norm, const LinearProblem& problem) {
  math::Matrix weighted = problem.shape;
  for (int j = 0; j < problem.columns(); ++j)
    for (int i = 0; i < problem.rows(); ++i) weighted(i, j) *= problem.weight[i];
  LinearFit fit;
  fit.x.resize(static_cast<std::size_t>(problem.columns()));
  std::vector<double> b(problem.weight.size());
  double sum = 0;
  for (int c = 0; c < 3; ++c) {
    for (std::size_t i = 0; i < b.size(); ++i) b[i] = problem.weight[i] * problem.value[i][c];
    const math::NonNegativeFit solved = norm == Norm::kL1 ? math::l1_fit(weighted, b) : math::nnls(weighted, b);
    fit.converged = fit.converged && solved.converged;
    fit.optimality_gap = std::max(fit.optimality_gap, solved.optimality_gap);
    sum += norm == Norm::kL1 ? solved.objective : solved.objective * solved.objective;
    for (std::size_t j = 0; j < fit.x.size(); ++j) fit.x[j][c] = solved.x[j];
  }
  fit.objective = norm == Norm::kL1 ? sum : std::sqrt(sum);
  return fit;
}

LinearProblem with_columns(const LinearProblem& problem, const std::vector<int>& columns) {
  LinearProblem part(math::Matrix(problem.rows(), static_cast<int>(columns.size())), problem.weight, problem.value);
  for (std::size_t j = 0; j < columns.size(); ++j)
    std::copy_n(problem.shape.column(columns[j]), problem.rows(), &part.shape(0, static_cast<int>(j)));
  return part;
}

std::vector<Vec3> predictions(const LinearProblem& problem, const std::vector<Vec3>& x) {
  std::vector<Vec3> shown(static_cast<std::size_t>(problem.rows()));
  for (int j = 0; j < problem.columns(); ++j) {
    if (x[j] == Vec3{}) continue;
    for (int i = 0; i < problem.rows(); ++i) shown[i] += problem.shape(i, j) * x[j];
  }
  return shown;
}

double error_norm(Norm norm, const LinearProblem& problem, const std::vector<Vec3>& x, bool plain) {
  const std::vector<Vec3> shown = predictions(problem, x);
  double sum = 0;
  for (std::size_t i = 0; i < shown.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const double r = (plain ? 1 : problem.weight[i]) * (problem.value[i][c] - shown[i][c]);
      sum += norm == Norm::kL1 ? std::abs(r) : r * r;
    }
  return norm == Norm::kL1 ? sum : std::sqrt(sum);
}

}  // namespace goniochrome::fit
