#include "fit/deltae_fit.h"

#include <algorithm>
#include <cmath>

#include "fit/solver.h"

namespace goniochrome {

namespace {

// Residuals: three for each reading (a vector of length dE00) and three for each guide. Parameters: x, column by
// column.
class Residuals final : public ceres::CostFunction {
 public:
  explicit Residuals(const DeltaEProblem& problem) : problem_(problem) {
    set_num_residuals(static_cast<int>(3 * (problem.readings.size() + problem.guides.size())));
    mutable_parameter_block_sizes()->push_back(3 * problem.columns);
  }

  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override {
    const double* x = parameters[0];
    double* jacobian = jacobians ? jacobians[0] : nullptr;
    const std::size_t width = 3 * static_cast<std::size_t>(problem_.columns);
    std::size_t row = 0;
    for (const auto& reading : problem_.readings) {
      const Rgb rgb = prediction(reading.shape, x);
      const Vec3 e = difference(reading.lab, rgb);
      for (int k = 0; k < 3; ++k) residuals[row + k] = e[k];
      if (jacobian) {
        for (int c = 0; c < 3; ++c) {
          const Vec3 slope = derivative(reading.lab, rgb, c);
          for (int k = 0; k < 3; ++k)
            for (int j = 0; j < problem_.columns; ++j)
              jacobian[(row + k) * width + 3 * j + c] = slope[k] * reading.shape[j];
        }
      }
      row += 3;
    }
    for (const auto& guide : problem_.guides) {
      const Rgb rgb = prediction(guide.shape, x);
      for (int c = 0; c < 3; ++c) {
        residuals[row + c] = guide.weight * (rgb[c] - guide.value[c]);
        if (!jacobian) continue;
        for (std::size_t j = 0; j < width; ++j) jacobian[(row + c) * width + j] = 0;
        for (int j = 0; j < problem_.columns; ++j)
          jacobian[(row + c) * width + 3 * j + c] = guide.weight * guide.shape[j];
      }
      row += 3;
    }
    return true;
  }

 private:
  static Rgb prediction(const std::vector<double>& shape, const double* x) {
    Rgb rgb;
    for (std::size_t j = 0; j < shape.size(); ++j) rgb += shape[j] * Rgb{x[3 * j], x[3 * j + 1], x[3 * j + 2]};
    return rgb;
  }
  Vec3 difference(const Lab& lab, const Rgb& rgb) const {
    return delta_e_2000_vector(lab, lab_from_rgb(rgb, problem_.white));
  }
  // By channel c, by central differences: their error of about 1e-10 moves the steps, not the minimum.
  Vec3 derivative(const Lab& lab, const Rgb& rgb, int c) const {
    const double step = 1e-5 * std::max(std::abs(rgb[c]), 1e-4);
    Rgb up = rgb, down = rgb;
    up[c] += step, down[c] -= step;
    return (1 / (2 * step)) * (difference(lab, up) - difference(lab, down));
  }

  const DeltaEProblem& problem_;
};

// How far x is from stationary: for each column of the derivative its cosine to the residual, where x may still move
// that way.
double stationarity(const Residuals& residuals, const std::vector<double>& x) {
  const std::size_t rows = static_cast<std::size_t>(residuals.num_residuals()), columns = x.size();
  std::vector<double> r(rows), j(rows * columns);
  const double* parameters = x.data();
  double* jacobian = j.data();
  residuals.Evaluate(&parameters, r.data(), &jacobian);
  double size = 0;
  for (const double v : r) size += v * v;
  if (size < 1e-20) return 0;
  double worst = 0;
  for (std::size_t k = 0; k < columns; ++k) {
    double gradient = 0, norm = 0;
    for (std::size_t i = 0; i < rows; ++i) {
      gradient += j[i * columns + k] * r[i];
      norm += j[i * columns + k] * j[i * columns + k];
    }
    if (norm == 0 || (x[k] <= 0 && gradient > 0)) continue;
    worst = std::max(worst, std::abs(gradient) / std::sqrt(norm * size));
  }
  return worst;
}

}  // namespace

DeltaEFit deltae_fit(const DeltaEProblem& problem, const std::vector<std::vector<Rgb>>& starts,
                     const Deadline& deadline) {
  DeltaEFit best;
  Residuals residuals(problem);
  std::vector<double> best_x;
  for (const std::vector<Rgb>& start : starts) {
    std::vector<double> x;
    for (const Rgb& rgb : start)
      for (int c = 0; c < 3; ++c) x.push_back(std::max(rgb[c], 0.0));
    ceres::Problem::Options ownership;
    ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ceres::Problem search(ownership);
    search.AddResidualBlock(&residuals, nullptr, x.data());
    for (std::size_t k = 0; k < x.size(); ++k) search.SetParameterLowerBound(x.data(), static_cast<int>(k), 0);
    ceres::Solver::Options options = quiet_solver_options();
    options.max_num_iterations = 400;
    options.function_tolerance = 1e-7;
    if (deadline.limit_s() > 0) options.max_solver_time_in_seconds = std::max(1e-6, deadline.left_s());
    ceres::Solver::Summary summary;
    ceres::Solve(options, &search, &summary);
    const double objective = std::sqrt(2 * summary.final_cost);
    if (!best_x.empty() && objective >= best.objective) continue;
    best.objective = objective;
    best.status = summary.termination_type == ceres::CONVERGENCE ? FitStatus::kOptimal
                  : deadline.passed()                            ? FitStatus::kTimeLimit
                                                                 : FitStatus::kNotConverged;
    best_x = x;
  }
  best.optimality_gap = stationarity(residuals, best_x);
  for (std::size_t j = 0; j < best_x.size(); j += 3) best.x.push_back({best_x[j], best_x[j + 1], best_x[j + 2]});
  return best;
}

}  // namespace goniochrome
