#include "panels/trompe.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/clock.h"
#include "base/text.h"
#include "fit/ceres_options.h"
#include "panels/internal/shading.h"

namespace goniochrome::panels {

namespace {

constexpr double kWorthwhile = 1e-3;  // dE by which a later candidate must be better

// The cost of a parameter that moves by one unit away from paint A, in dE: enough to keep undetermined parameters where
// they were, and too little to move a determined one.
constexpr double kAnchor = 1e-3;

// The largest power that stands in for the maximum.
constexpr double kLargestPower = 64;

// The residuals of the views: the Lab difference times the square root of the view's share of the weight, three for
// each view, or, with a power p > 2, the length of the difference over `scale` to the power p/2, one for each view.
struct ResidualShape {
  double power = 2, scale = 1;
  TrompeValues tie{};  // of a solid paint: flop minus face
  bool tied = false;
};

// Adds the residuals of all views to a problem whose only parameter block is the seven values of paint B.
using TrompeModel = std::function<void(ceres::Problem&, double* values, const ResidualShape&)>;

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

// The Lab of paint B minus the target in all views at once, by a function.
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

// Paint B by its curve at the aspecular angle of each view.
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

// Paint B by `colors`; as many weights as there are colors in `target`.
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

ceres::Solver::Options solver_options(int iterations, double tolerance) {
  ceres::Solver::Options options = fit::quiet_solver_options();
  options.function_tolerance = tolerance, options.gradient_tolerance = tolerance;
  options.parameter_tolerance = tolerance;
  options.max_num_iterations = iterations;
  return options;
}

// The searches for paint B around paint A.
class Search {
 public:
  Search(const TrompeModel& model, const TrompeValues& a, const TrompeOptions& options, bool tied)
      : model_(model), a_(a), options_(options) {
    shape_.tied = tied;
    for (int c = 0; c < 3; ++c) shape_.tie[kFlopL + c] = a[kFlopL + c] - a[kFaceL + c];
  }

  // The least weighted RMS difference from one start; false where the solver did not converge.
  bool least_rms(TrompeValues& values) const {
    follow_face(shape_, values);
    BoundProblem bound(*this, values, shape_);
    bound.problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<AnchorResidual, kTrompeParameters, kTrompeParameters>(new AnchorResidual{a_}),
        nullptr, bound.values.data());
    ceres::Solver::Summary summary;
    ceres::Solve(solver_options(100, 1e-14), &bound.problem, &summary);
    values = bound.values;
    follow_face(shape_, values);
    return summary.termination_type == ceres::CONVERGENCE;
  }

  // Values on the way from a start to the least maximum, the last of which need not be the best: powers 4, 16 and
  // kLargestPower of the differences, each begun where the one before ended and scaled by the largest difference there.
  std::vector<TrompeValues> toward_least_maximum(TrompeValues at) const {
    ResidualShape shape = shape_;
    std::vector<TrompeValues> way;
    for (shape.power = 4; shape.power <= kLargestPower; shape.power *= 4) {
      shape.scale = std::max(largest_difference(at), 1e-9);
      BoundProblem bound(*this, at, shape);
      ceres::Solver::Summary summary;
      ceres::Solve(solver_options(25, 1e-9), &bound.problem, &summary);
      at = bound.values;
      follow_face(shape, at);
      way.push_back(at);
    }
    return way;
  }

  // For each parameter by how much the RMS difference grows when it moves by one unit and the others make up for it as
  // far as they can; 0 for those held. With G = J'J of the residuals (which sum to the squared RMS), it is
  // 1/sqrt((G^-1)_pp): by eigenvalues, with those of rounding set to a floor.
  std::vector<double> grip(const TrompeValues& at) const {
    BoundProblem bound(*this, at, shape_);
    ceres::CRSMatrix j;
    bound.problem.Evaluate({}, nullptr, nullptr, nullptr, &j);
    Eigen::MatrixXd G = Eigen::MatrixXd::Zero(j.num_cols, j.num_cols);
    for (int row = 0; row < j.num_rows; ++row)
      for (int x = j.rows[row]; x < j.rows[row + 1]; ++x)
        for (int y = j.rows[row]; y < j.rows[row + 1]; ++y) G(j.cols[x], j.cols[y]) += j.values[x] * j.values[y];
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(G);
    std::vector<double> grip(kTrompeParameters, 0.0);
    for (int p = 0, column = 0; p < kTrompeParameters; ++p) {
      if (!options_.vary[p]) continue;
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

 private:
  // A problem over one block of seven values, of which some are held.
  struct BoundProblem {
    ceres::Problem problem;
    TrompeValues values;

    BoundProblem(const Search& search, const TrompeValues& at, const ResidualShape& shape) : values(at) {
      search.model_(problem, values.data(), shape);
      const TrompeOptions& options = search.options_;
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

  double largest_difference(TrompeValues at) const {
    ResidualShape shape = shape_;
    shape.power = 4;  // then the residual is the squared difference
    ceres::Problem problem;
    model_(problem, at.data(), shape);
    std::vector<double> residuals;
    problem.Evaluate({}, nullptr, &residuals, nullptr, nullptr);
    return std::sqrt(*std::ranges::max_element(residuals));
  }

  const TrompeModel& model_;
  const TrompeValues a_;
  const TrompeOptions& options_;
  ResidualShape shape_;
};

color::Lab view_color(const paint::Appearance& paint, double aspecular_deg, double cos_light) {
  return panel_color(paint::lab_at(paint, aspecular_deg), cos_light);
}

Result<void> check_problem(const paint::Appearance& a, std::size_t views, const TrompeOptions& options) {
  GONIO_TRY(paint::check(a));
  if (views == 0) return input_error("no view of both panels is left: give lights and viewers that see them");
  if (std::ranges::none_of(options.vary, [](bool v) { return v; }))
    return usage_error("there is nothing to vary: name at least one of face, flop and travel");
  for (int p = 0; p < kTrompeParameters; ++p)
    if (!(options.low[p] < options.high[p]))
      return usage_error("the bounds of {} are {} to {}: the first must be the smaller", parameter_name(p),
                         shortest(options.low[p]), shortest(options.high[p]));
  if (options.low[kTravel] <= paint::kFaceAngle_deg || options.high[kTravel] > 180)
    return usage_error("the bounds of travel are {} to {}: it lies above 15 and up to 180",
                       shortest(options.low[kTravel]), shortest(options.high[kTravel]));
  return {};
}

// Starts: paint A itself; A with travels shorter and longer, since the objective bends where views enter the plateau;
// and A brighter and darker.
std::vector<TrompeValues> starts_from(const TrompeValues& a, const TrompeOptions& options, bool solid) {
  std::vector<TrompeValues> starts = {a};
  if (options.vary[kTravel] && !solid) {
    for (const double shift : {-12.0, 12.0}) {
      starts.push_back(a);
      starts.back()[kTravel] += shift;
    }
  }
  if (options.vary[kFaceL]) {
    starts.push_back(a);
    starts.back()[kFaceL] *= 1.1;
  }
  for (TrompeValues& start : starts)
    for (int p = 0; p < kTrompeParameters; ++p)
      if (options.vary[p]) start[p] = std::clamp(start[p], options.low[p], options.high[p]);
  return starts;
}

// One solver for both kinds of light: `model` adds the residuals to a Ceres problem, `errors` judges a solution
// exactly.
Result<TrompeFit> fit_model(const paint::Appearance& a, bool is_solid, const TrompeModel& model,
                            const std::function<Result<TrompeErrors>(const paint::Appearance&)>& errors,
                            const TrompeOptions& asked) {
  const Stopwatch clock;
  TrompeFit fit;
  // A solid paint has only the face free.
  TrompeOptions options = asked;
  fit.solid = is_solid || color::delta_e_76(a.face, a.flop) < kSolidContrast;
  if (fit.solid) options.vary[kFlopL] = options.vary[kFlopA] = options.vary[kFlopB] = options.vary[kTravel] = false;
  if (std::ranges::none_of(options.vary, [](bool v) { return v; }))
    return usage_error("a solid paint has neither flop nor travel to vary: vary its face");
  GONIO_ASSIGN(fit.before, errors(a));
  const Search search(model, values_of(a), options, fit.solid);
  // Candidates, by what is to be least.
  bool any = false;  // a first answer, even where bounds make it worse than paint A
  const auto key = [&](const TrompeErrors& e) { return options.least_maximum ? e.max : e.rms; };
  const auto consider = [&](const TrompeValues& values) -> Result<void> {
    const paint::Appearance candidate = appearance_of(values);
    GONIO_ASSIGN(TrompeErrors after, errors(candidate));
    // Among optima that look the same the first one is kept, which is nearest to paint A.
    if (any && key(after) >= key(fit.after) - kWorthwhile) return {};
    fit.b = candidate, fit.after = std::move(after), any = true;
    return {};
  };
  for (TrompeValues values : starts_from(values_of(a), options, fit.solid)) {
    fit.converged = search.least_rms(values) && fit.converged;
    ++fit.starts;
    GONIO_TRY(consider(values));
  }
  if (options.least_maximum)
    for (const TrompeValues& values : search.toward_least_maximum(values_of(fit.b))) GONIO_TRY(consider(values));
  fit.b.residual_de00.reset();
  // Parameters that the views leave open, and those that a bound holds back.
  const TrompeValues found = values_of(fit.b);
  const std::vector<double> grip = search.grip(found);
  for (int p = 0; p < kTrompeParameters; ++p) {
    if (!options.vary[p]) continue;
    if (grip[p] < kDeterminedBy) fit.undetermined.emplace_back(parameter_name(p));
    if (found[p] <= options.low[p] + 1e-6 || found[p] >= options.high[p] - 1e-6)
      fit.at_bound.emplace_back(parameter_name(p));
  }
  fit.time_ms = clock.elapsed_s() * 1e3;
  return fit;
}

}  // namespace

std::optional<PanelView> panel_view(const LightView& geometry, double seam_deg, double b_deg) {
  const TiltedPair pair = TiltedPair::make(geometry, seam_deg);
  if (std::abs(b_deg) >= pair.range_deg(b_deg < 0 ? -1 : 1)) return std::nullopt;
  const TiltedPair::State a = pair.at(0), b = pair.at(b_deg);
  return PanelView{a.aspecular_deg, a.cos_light, b.aspecular_deg, b.cos_light, 1, a.cos_view, b.cos_view};
}

PanelView PanelView::under_coat(double coat_index) const {
  PanelView view = *this;
  view.cos_a = TiltedPair::State{aspecular_a_deg, cos_a, cos_view_a}.shade(coat_index);
  view.cos_b = TiltedPair::State{aspecular_b_deg, cos_b, cos_view_b}.shade(coat_index);
  return view;
}

std::vector<PanelView> under_coat(std::vector<PanelView> views, double coat_index) {
  for (PanelView& view : views) view = view.under_coat(coat_index);
  return views;
}

const char* parameter_name(int parameter) {
  static constexpr const char* kNames[] = {"face_l", "face_a", "face_b", "flop_l", "flop_a", "flop_b", "travel"};
  return kNames[parameter];
}

TrompeValues values_of(const paint::Appearance& x) {
  return {x.face.L, x.face.a, x.face.b, x.flop.L, x.flop.a, x.flop.b, x.travel_deg};
}

paint::Appearance appearance_of(const TrompeValues& v) {
  return {{v[kFaceL], v[kFaceA], v[kFaceB]}, {v[kFlopL], v[kFlopA], v[kFlopB]}, v[kTravel], {}};
}

TrompeErrors trompe_errors(const std::vector<color::Lab>& a, const std::vector<color::Lab>& b,
                           const std::vector<double>& weights) {
  TrompeErrors errors;
  double squares = 0, weight = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double de = color::delta_e_76(a[i], b[i]);
    errors.de.push_back(de);
    errors.max = std::max(errors.max, de);
    squares += weights[i] * de * de, weight += weights[i];
  }
  errors.rms = std::sqrt(squares / weight);
  return errors;
}

TrompeErrors trompe_errors(const paint::Appearance& a, const paint::Appearance& b,
                           const std::vector<PanelView>& views) {
  std::vector<color::Lab> target, shown;
  std::vector<double> weights;
  for (const PanelView& view : views) {
    target.push_back(view_color(a, view.aspecular_a_deg, view.cos_a));
    shown.push_back(view_color(b, view.aspecular_b_deg, view.cos_b));
    weights.push_back(view.weight);
  }
  return trompe_errors(target, shown, weights);
}

Result<TrompeFit> trompe_fit(const paint::Appearance& a, bool is_solid, const std::vector<PanelView>& views,
                             const TrompeOptions& options) {
  GONIO_TRY(check_problem(a, views.size(), options));
  std::vector<color::Lab> target;
  for (const PanelView& view : views) target.push_back(view_color(a, view.aspecular_a_deg, view.cos_a));
  return fit_model(
      a, is_solid, view_model(target, views),
      [&](const paint::Appearance& b) -> Result<TrompeErrors> { return trompe_errors(a, b, views); }, options);
}

Result<TrompeFit> trompe_fit(const paint::Appearance& a, bool is_solid, const std::vector<color::Lab>& target,
                             const std::vector<double>& weights, const PanelColors& colors,
                             const TrompeOptions& options) {
  GONIO_TRY(check_problem(a, target.size(), options));
  return fit_model(
      a, is_solid, color_model(target, weights, colors),
      [&](const paint::Appearance& b) -> Result<TrompeErrors> {
        GONIO_ASSIGN(const std::vector<color::Lab> shown, colors(b));
        return trompe_errors(target, shown, weights);
      },
      options);
}

}  // namespace goniochrome::panels
