#include "panels/trompe.h"

#include <algorithm>
#include <cmath>

#include "base/clock.h"
#include "base/text.h"
#include "panels/internal/goniogeom_shading.h"
#include "panels/internal/trompe_solver.h"

namespace goniochrome::panels {

namespace {

constexpr double kWorthwhile = 1e-3;  // dE

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

}  // namespace

std::optional<PanelView> panel_view(const LightView& geometry, double seam_deg, double b_deg) {
  const TiltedPair pair = TiltedPair::make(geometry, seam_deg);
  if (std::abs(b_deg) >= pair.range_deg(b_deg < 0 ? -1 : 1)) return std::nullopt;
  const TiltedPair::State a = pair.at(0), b = pair.at(b_deg);
  return PanelView{a.aspecular_deg, a.cos_light, b.aspecular_deg, b.cos_light, 1};
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

// One solver for both kinds of light: `model` adds the residuals to a Ceres problem, `errors` judges a solution
// exactly.
static Result<TrompeFit> fit_model(const paint::Appearance& a, bool is_solid, const TrompeModel& model,
                                   const std::function<Result<TrompeErrors>(const paint::Appearance&)>& errors,
                                   const TrompeOptions& asked) {
  const Stopwatch clock;
  TrompeFit fit;
  TrompeOptions options = asked;
  fit.solid = is_solid || color::delta_e_76(a.face, a.flop) < kSolidContrast;
  if (fit.solid) options.vary[kFlopL] = options.vary[kFlopA] = options.vary[kFlopB] = options.vary[kTravel] = false;
  if (std::ranges::none_of(options.vary, [](bool v) { return v; }))
    return usage_error("a solid paint has neither flop nor travel to vary: vary its face");
  GONIO_ASSIGN(fit.before, errors(a));
  const TrompeValues anchor = values_of(a);
  bool any = false;  // a first answer, even where bounds make it worse than paint A
  const auto key = [&](const TrompeErrors& e) { return options.least_maximum ? e.max : e.rms; };
  const auto consider = [&](const TrompeValues& values) -> Result<void> {
    const paint::Appearance candidate = appearance_of(values);
    GONIO_ASSIGN(TrompeErrors after, errors(candidate));
    // A later candidate has to win by what could be seen of it: of equal optima the one nearest to paint A is kept.
    if (any && key(after) >= key(fit.after) - kWorthwhile) return {};
    fit.b = candidate, fit.after = std::move(after), any = true;
    return {};
  };
  for (const TrompeValues& start : starts_from(anchor, options, fit.solid)) {
    const TrompeSolution solution = least_rms(model, anchor, start, options, fit.solid);
    fit.converged = fit.converged && solution.converged;
    ++fit.starts;
    GONIO_TRY(consider(solution.values));
  }
  if (options.least_maximum)
    for (const TrompeValues& values : toward_least_maximum(model, anchor, values_of(fit.b), options, fit.solid))
      GONIO_TRY(consider(values));
  fit.b.residual_de00.reset();
  const std::vector<double> grip = parameter_grip(model, anchor, values_of(fit.b), options, fit.solid);
  const TrompeValues found = values_of(fit.b);
  for (int p = 0; p < kTrompeParameters; ++p) {
    if (!options.vary[p]) continue;
    if (grip[p] < kDeterminedBy) fit.undetermined.emplace_back(parameter_name(p));
    if (found[p] <= options.low[p] + 1e-6 || found[p] >= options.high[p] - 1e-6)
      fit.at_bound.emplace_back(parameter_name(p));
  }
  fit.time_ms = clock.elapsed_s() * 1e3;
  return fit;
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
