#include "panels/internal/trompe_solver.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "panels/internal/goniogeom_shading.h"

namespace goniochrome::panels {

namespace {

// So weakly does a parameter hold on to paint A, in dE for one unit: enough to keep what no view determines where it
// was, too little to move what one does.
constexpr double kAnchor = 1e-3;

// The largest power that stands in for the maximum.
constexpr double kLargestPower = 64;

// The flop of a solid paint follows its face.
template <class T>
void follow_face(const ResidualShape& shape, std::array<T, kTrompeParameters>& v) {
  if (!shape.tied) return;
  for (int c = 0; c < 3; ++c) v[kFlopL + c] = v[kFaceL + c] + shape.tie[kFlopL + c];
}

// Residuals of one difference d: its channels, or its length to a power.
template <class T>
void write_residual(const std::array<T, 3>& d, double share, const ResidualShape& shape, T* residual) {
  if (shape.power == 2) {
    for (int c = 0; c < 3; ++c) residual[c] = std::sqrt(share) * d[c];
    return;
  }
  using std::pow;
  const double s = shape.scale * shape.scale;
  const T squares = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) / s + 1e-12;
  residual[0] = pow(squares, shape.power / 4);
}

// Lab of paint B in one view minus the target.
struct ViewResidual {
  color::Lab target;
  PanelView view;
  double k, share;
  ResidualShape shape;

  template <class T>
  bool operator()(const T* values, T* residual) const {
    std::array<T, kTrompeParameters> v;
    std::copy_n(values, kTrompeParameters, v.begin());
    follow_face(shape, v);
    const T travel = v[kTravel];
    T w(0.0);
    if (view.aspecular_b_deg < travel) {
      const T part = (travel - view.aspecular_b_deg) / (travel - paint::kFaceAngle_deg);
      w = part * part;
    }
    std::array<T, 3> lab;
    for (int c = 0; c < 3; ++c) lab[c] = v[kFlopL + c] + (v[kFaceL + c] - v[kFlopL + c]) * w;
    std::array<T, 3> d = shaded_lab<T>(lab, view.cos_b, k);
    d[0] -= target.L, d[1] -= target.a, d[2] -= target.b;
    write_residual(d, share, shape, residual);
    return true;
  }
};

// All views at once, by a function.
struct ColorResidual {
  std::vector<color::Lab> target;
  std::vector<double> share;
  PanelColors colors;
  ResidualShape shape;

  bool operator()(double const* const* values, double* residual) const {
    TrompeValues v;
    std::copy_n(values[0], kTrompeParameters, v.begin());
    follow_face(shape, v);
    const auto shown = colors(appearance_of(v));
    if (!shown.ok()) return false;
    const int each = shape.power == 2 ? 3 : 1;
    for (std::size_t i = 0; i < target.size(); ++i) {
      const color::Lab &x = (*shown)[i], &y = target[i];
      write_residual<double>({x.L - y.L, x.a - y.a, x.b - y.b}, share[i], shape, residual + each * i);
    }
    return true;
  }
};

struct AnchorResidual {
  TrompeValues anchor;
  template <class T>
  bool operator()(const T* values, T* residual) const {
    for (int p = 0; p < kTrompeParameters; ++p) residual[p] = kAnchor * (values[p] - anchor[p]);
    return true;
  }
};

// A problem over one block of seven values, of which some are held.
struct BoundProblem {
  ceres::Problem problem;
  TrompeValues values;

  BoundProblem(const TrompeModel& model, const TrompeValues& at, const TrompeOptions& options,
               const ResidualShape& shape)
      : values(at) {
    model(problem, values.data(), shape);
    std::vector<int> held;
    for (int p = 0; p < kTrompeParameters; ++p) {
      if (!options.vary[p]) {
        held.push_back(p);
        continue;
      }
      values[p] = std::clamp(values[p], options.low[p], options.high[p]);
      problem.SetParameterLowerBound(values.data(), p, options.low[p]);
      problem.SetParameterUpperBound(values.data(), p, options.high[p]);
    }
    if (!held.empty()) problem.SetManifold(values.data(), new ceres::SubsetManifold(kTrompeParameters, held));
  }
};

ResidualShape shape_of(const TrompeValues& anchor, bool tied) {
  ResidualShape shape;
  shape.tied = tied;
  for (int c = 0; c < 3; ++c) shape.tie[kFlopL + c] = anchor[kFlopL + c] - anchor[kFaceL + c];
  return shape;
}

ceres::Solver::Options solver_options(int iterations, double tolerance) {
  ceres::Solver::Options options = fit::quiet_solver_options();
  options.function_tolerance = tolerance, options.gradient_tolerance = tolerance;
  options.parameter_tolerance = tolerance;
  options.max_num_iterations = iterations;
  return options;
}

double largest_difference(const TrompeModel& model, const TrompeValues& at, ResidualShape shape) {
  shape.power = 4, shape.scale = 1;  // then the residual is the squared difference
  ceres::Problem problem;
  TrompeValues values = at;
  model(problem, values.data(), shape);
  std::vector<double> residuals;
  problem.Evaluate({}, nullptr, &residuals, nullptr, nullptr);
  return std::sqrt(*std::ranges::max_element(residuals));
}

}  // namespace

TrompeModel view_model(const std::vector<color::Lab>& target, const std::vector<PanelView>& views) {
  double sum = 0;
  for (const PanelView& view : views) sum += view.weight;
  return [target, views, sum](ceres::Problem& problem, double* values, const ResidualShape& shape) {
    for (std::size_t i = 0; i < views.size(); ++i) {
      auto* residual = new ViewResidual{target[i], views[i], std::cbrt(views[i].cos_b), views[i].weight / sum, shape};
      ceres::CostFunction* cost = nullptr;
      if (shape.power == 2) {
        cost = new ceres::AutoDiffCostFunction<ViewResidual, 3, kTrompeParameters>(residual);
      } else {
        cost = new ceres::AutoDiffCostFunction<ViewResidual, 1, kTrompeParameters>(residual);
      }
      problem.AddResidualBlock(cost, nullptr, values);
    }
  };
}

TrompeModel color_model(const std::vector<color::Lab>& target, const std::vector<double>& weights,
                        const PanelColors& colors) {
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  std::vector<double> share;
  for (const double weight : weights) share.push_back(weight / sum);
  return [target, share, colors](ceres::Problem& problem, double* values, const ResidualShape& shape) {
    ceres::NumericDiffOptions steps;
    steps.relative_step_size = 1e-4;
    auto* cost = new ceres::DynamicNumericDiffCostFunction<ColorResidual, ceres::CENTRAL>(
        new ColorResidual{target, share, colors, shape}, ceres::TAKE_OWNERSHIP, steps);
    cost->AddParameterBlock(kTrompeParameters);
    cost->SetNumResiduals(static_cast<int>(target.size()) * (shape.power == 2 ? 3 : 1));
    problem.AddResidualBlock(cost, nullptr, values);
  };
}

TrompeSolution least_rms(const TrompeModel& model, const TrompeValues& anchor, const TrompeValues& start,
                         const TrompeOptions& options, bool tied) {
  const ResidualShape shape = shape_of(anchor, tied);
  TrompeValues at = start;
  follow_face(shape, at);
  BoundProblem bound(model, at, options, shape);
  bound.problem.AddResidualBlock(
      new ceres::AutoDiffCostFunction<AnchorResidual, kTrompeParameters, kTrompeParameters>(new AnchorResidual{anchor}),
      nullptr, bound.values.data());
  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(100, 1e-14), &bound.problem, &summary);
  follow_face(shape, bound.values);
  return {bound.values, summary.termination_type == ceres::CONVERGENCE};
}

// Powers 4, 16 and kLargestPower of the differences, each begun where the one before ended and scaled by the
// largest difference there; the caller judges by the exact maximum.
std::vector<TrompeValues> toward_least_maximum(const TrompeModel& model, const TrompeValues& anchor,
                                               const TrompeValues& start, const TrompeOptions& options, bool tied) {
  ResidualShape shape = shape_of(anchor, tied);
  std::vector<TrompeValues> way;
  TrompeValues at = start;
  for (shape.power = 4; shape.power <= kLargestPower; shape.power *= 4) {
    shape.scale = std::max(largest_difference(model, at, shape), 1e-9);
    BoundProblem bound(model, at, options, shape);
    ceres::Solver::Summary summary;
    ceres::Solve(solver_options(25, 1e-9), &bound.problem, &summary);
    at = bound.values;
    follow_face(shape, at);
    way.push_back(at);
  }
  return way;
}

// With G = J'J of the residuals (which sum to the squared RMS), the least RMS for a unit move of p is
// 1/sqrt((G^-1)_pp): by eigenvalues, with those of rounding set to a floor.
std::vector<double> parameter_grip(const TrompeModel& model, const TrompeValues& anchor, const TrompeValues& at,
                                   const TrompeOptions& options, bool tied) {
  BoundProblem bound(model, at, options, shape_of(anchor, tied));
  ceres::CRSMatrix j;
  bound.problem.Evaluate({}, nullptr, nullptr, nullptr, &j);
  Eigen::MatrixXd G = Eigen::MatrixXd::Zero(j.num_cols, j.num_cols);
  for (int row = 0; row < j.num_rows; ++row)
    for (int x = j.rows[row]; x < j.rows[row + 1]; ++x)
      for (int y = j.rows[row]; y < j.rows[row + 1]; ++y) G(j.cols[x], j.cols[y]) += j.values[x] * j.values[y];
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(G);
  std::vector<double> grip(kTrompeParameters, 0.0);
  for (int p = 0, column = 0; p < kTrompeParameters; ++p) {
    if (!options.vary[p]) continue;
    double inverse = 0;
    for (int k = 0; k < G.cols(); ++k) {
      const double part = eigen.eigenvectors()(column, k);
      inverse += part * part / std::max(eigen.eigenvalues()(k), 1e-14);
    }
    grip[p] = 1 / std::sqrt(inverse);
    ++column;
  }
  return grip;
}

}  // namespace goniochrome::panels
