#include "fit/internal/flake_fit.h"

#include <algorithm>
#include <cmath>

#include "brdf/lobe_model.h"
#include "fit/internal/deltae_fit.h"
#include "math/cosine_power.h"

namespace goniochrome::fit {

namespace {

// A squared norm feels many small rows more than the sum of absolute values does, so the inferred ones steer the color
// search with less weight than the linear fits.
constexpr double kGuideShare = 0.1;

// How much it counts, in each row, that the next view shows something else.
constexpr double kSmoothnessShare = 0.1;

// Rows that ask two neighboring views to show the same, at the angles of the target's rows, no closer than about 9 deg.
void add_smoothness(const FlakeTarget& target, const FlakeModel& model, LinearProblem& problem) {
  const int views = static_cast<int>(model.views_deg.size()), width = model.columns_per_view();
  constexpr double kApart_rad = 0.16;
  std::vector<const FlakeRow*> angles;
  for (const FlakeRow& row : target.rows)
    if (std::ranges::none_of(angles, [&](const FlakeRow* other) {
          return std::abs(other->at.aspecular_rad - row.at.aspecular_rad) < kApart_rad;
        }))
      angles.push_back(&row);
  const int known = problem.rows(), more = (views - 1) * static_cast<int>(angles.size());
  math::Matrix all(known + more, problem.columns());
  for (int j = 0; j < problem.columns(); ++j) std::copy_n(problem.shape.column(j), known, &all(0, j));
  std::vector<double> shape(static_cast<std::size_t>(width));
  int i = known;
  for (const FlakeRow* row : angles) {
    const FlakeModel plain{model.exponents};
    plain.shape(row->at, shape.data());
    for (int v = 0; v + 1 < views; ++v, ++i) {
      for (int j = 0; j < width; ++j) all(i, v * width + j) = -shape[j], all(i, (v + 1) * width + j) = shape[j];
      problem.weight.push_back(kSmoothnessShare * row->weight);
      problem.value.push_back({});
    }
  }
  problem.shape = std::move(all);
}

DeltaEProblem deltae_problem(const FlakeTarget& target, const FlakeModel& model, const LinearProblem& linear) {
  DeltaEProblem problem;
  problem.columns = model.columns();
  problem.white = target.white;
  const auto width = static_cast<std::size_t>(problem.columns);
  for (const FlakeReading& reading : target.readings) {
    std::vector<double> shape(width);
    model.shape(reading.at, shape.data());
    problem.readings.push_back({std::move(shape), reading.lab});
  }
  for (int i = 0; i < linear.rows(); ++i) {
    if (i < static_cast<int>(target.rows.size()) && !target.rows[i].inferred) continue;
    std::vector<double> shape(width);
    for (std::size_t j = 0; j < width; ++j) shape[j] = linear.shape(i, static_cast<int>(j));
    problem.guides.push_back({std::move(shape), linear.value[i], kGuideShare * linear.weight[i]});
  }
  return problem;
}

}  // namespace

Norm norm_of(FitMethod method) {
  return method == FitMethod::kL1 ? Norm::kL1 : Norm::kL2;
}

void FlakeModel::shape(const FlakePoint& at, double* columns) const {
  const int width = columns_per_view();
  const double log_cos = math::log_cosine(at.aspecular_rad);
  const auto lobes = [&](double* first, double share) {
    first[0] = share;
    for (int j = 1; j < width; ++j) first[j] = share * math::power_of_cosine(log_cos, exponents[j - 1]);
  };
  if (views_deg.empty()) return lobes(columns, 1);
  std::fill(columns, columns + this->columns(), 0.0);
  const auto above = std::ranges::upper_bound(views_deg, at.view_deg) - views_deg.begin();
  const auto last = static_cast<std::ptrdiff_t>(views_deg.size()) - 1;
  if (above == 0 || above > last) return lobes(columns + width * std::min(above, last), 1);
  const double share = (at.view_deg - views_deg[above - 1]) / (views_deg[above] - views_deg[above - 1]);
  lobes(columns + width * (above - 1), 1 - share);
  lobes(columns + width * above, share);
}

color::Rgb shown(const FlakeModel& model, const std::vector<color::Rgb>& x, const FlakePoint& at) {
  std::vector<double> shape(x.size());
  model.shape(at, shape.data());
  color::Rgb sum;
  for (std::size_t j = 0; j < x.size(); ++j) sum += shape[j] * x[j];
  return sum;
}

LinearProblem linear_problem(const FlakeTarget& target, const FlakeModel& model) {
  LinearProblem problem(math::Matrix(static_cast<int>(target.rows.size()), model.columns()), {}, {});
  std::vector<double> shape(static_cast<std::size_t>(model.columns()));
  for (int i = 0; i < problem.rows(); ++i) {
    model.shape(target.rows[i].at, shape.data());
    for (int j = 0; j < problem.columns(); ++j) problem.shape(i, j) = shape[j];
    problem.weight.push_back(target.rows[i].weight);
    problem.value.push_back(target.rows[i].value);
  }
  return problem;
}

FlakeFit flake_fit(FitMethod method, const FlakeTarget& target, const FlakeModel& model, const Deadline& deadline) {
  LinearProblem problem = linear_problem(target, model);
  if (model.views_deg.size() > 1) add_smoothness(target, model, problem);
  FlakeFit fit;
  if (method == FitMethod::kDeltaE) {
    const std::vector<std::vector<color::Rgb>> starts = {linear_fit(Norm::kL1, problem).x,
                                                         linear_fit(Norm::kL2, problem).x};
    DeltaEFit best = deltae_fit(deltae_problem(target, model, problem), starts, deadline);
    fit.x = std::move(best.x);
    fit.optimality_gap = best.optimality_gap;
    fit.status = best.status;
  } else {
    LinearFit best = linear_fit(norm_of(method), problem);
    fit.x = std::move(best.x);
    fit.optimality_gap = best.optimality_gap;
    if (!best.converged) fit.status = FitStatus::kNotConverged;
  }
  fit.objective = error_norm(norm_of(method), problem, fit.x);
  fit.plain_objective = error_norm(norm_of(method), problem, fit.x, true);
  return fit;
}

}  // namespace goniochrome::fit
