#include "fit/internal/basis_lm.h"

#include <algorithm>
#include <cmath>

#include "fit/ceres_options.h"

namespace goniochrome::fit {

namespace {

// One residual per target: its RMS error, with the derivative by log E from the
// envelope theorem.
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
    std::vector<double> exponents(lobes);
    for (std::size_t j = 0; j < lobes; ++j) exponents[j] = std::exp(parameters[0][j]);
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

}  // namespace

int minimize_by_levenberg_marquardt(const std::vector<BasisTarget>& targets, double low, double high,
                                    const Deadline& deadline, std::vector<double>& logs) {
  int evaluations = 0;
  ceres::Problem problem;
  problem.AddResidualBlock(new TargetErrors(targets, logs.size(), evaluations), nullptr, logs.data());
  for (std::size_t j = 0; j < logs.size(); ++j) {
    problem.SetParameterLowerBound(logs.data(), static_cast<int>(j), low);
    problem.SetParameterUpperBound(logs.data(), static_cast<int>(j), high);
  }
  ceres::Solver::Options options = quiet_solver_options();
  options.max_num_iterations = 100;
  if (deadline.limit_s() > 0) options.max_solver_time_in_seconds = std::max(0.01, deadline.left_s());
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return evaluations;
}

}  // namespace goniochrome::fit
