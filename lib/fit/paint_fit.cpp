#include "fit/paint_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/clock.h"
#include "base/parallel.h"
#include "fit/deltae_fit.h"
#include "fit/target_rows.h"
#include "math/least_squares.h"

namespace goniochrome {

namespace {

// The exponents that the samples see, as indices into `exponents`.
std::vector<int> seen_lobes(const std::vector<double>& exponents, double first_rad) {
  std::vector<int> seen;
  for (std::size_t j = 0; j < exponents.size(); ++j)
    if (cos_power(first_rad, exponents[j]) >= kSeenPart) seen.push_back(static_cast<int>(j));
  return seen;
}

double norm_of(FitMethod method, const std::vector<double>& residuals) {
  double sum = 0;
  for (const double r : residuals) sum += method == FitMethod::kL1 ? std::abs(r) : r * r;
  return method == FitMethod::kL1 ? sum : std::sqrt(sum);
}

// The linear problem of a paint: rows of the target, columns the constant and the seen lobes; reflectance factors.
struct System {
  Matrix shape;
  std::vector<double> weight;
};

System system_of(const FitOptions& options, const Target& target, const std::vector<double>& exponents,
                 const std::vector<int>& seen) {
  System s{Matrix(static_cast<int>(target.rows.size()), static_cast<int>(seen.size()) + 1), {}};
  for (int i = 0; i < s.shape.rows; ++i) {
    const TargetRow& row = target.rows[i];
    s.weight.push_back(row.importance * (options.perceptual_weights ? lightness_slope(row.lightness) : 1));
    for (int j = 0; j < s.shape.columns; ++j)
      s.shape(i, j) = j == 0 ? 1 : cos_power(row.angle_deg * (M_PI / 180), exponents[seen[j - 1]]);
  }
  return s;
}

// One weight triple per column, channel by channel the optimum of its norm.
std::vector<Rgb> linear_solution(FitMethod method, const System& s, const Target& target, PaintFitReport& report) {
  Matrix weighted = s.shape;
  for (int i = 0; i < s.shape.rows; ++i)
    for (int j = 0; j < s.shape.columns; ++j) weighted(i, j) *= s.weight[i];
  std::vector<Rgb> x(static_cast<std::size_t>(s.shape.columns));
  std::vector<double> b(s.weight.size());
  for (int c = 0; c < 3; ++c) {
    for (int i = 0; i < s.shape.rows; ++i) b[i] = s.weight[i] * target.rows[i].reflectance_factor[c];
    const NonNegativeFit solved = method == FitMethod::kL1 ? l1_fit(weighted, b) : nnls(weighted, b);
    if (!solved.converged) report.status = "not_converged";
    report.optimality_gap = std::max(report.optimality_gap, solved.optimality_gap);
    for (std::size_t j = 0; j < x.size(); ++j) x[j][c] = solved.x[j];
  }
  return x;
}

// A squared norm feels many small rows more than the sum of absolute values does, so the inferred ones steer the color
// search with less weight than the linear fits.
constexpr double kGuideShare = 0.1;

// Both linear solutions, then the color differences at the readings made least; the inferred rows go on steering.
std::vector<Rgb> deltae_solution(const System& s, const Target& target, const std::vector<double>& exponents,
                                 const std::vector<int>& seen, const Xyz& white, PaintFitReport& report) {
  DeltaEProblem problem;
  problem.columns = s.shape.columns;
  problem.white = white;
  for (const LabReading& reading : target.readings) {
    const double angle_rad = aspecular_angle_deg(reading.geometry) * (M_PI / 180);
    std::vector<double> shape = {1};
    for (const int j : seen) shape.push_back(cos_power(angle_rad, exponents[j]));
    problem.readings.push_back({shape, reading.lab});
  }
  for (int i = 0; i < s.shape.rows; ++i) {
    if (target.rows[i].importance >= 1) continue;
    std::vector<double> shape;
    for (int j = 0; j < s.shape.columns; ++j) shape.push_back(s.shape(i, j));
    problem.guides.push_back({shape, target.rows[i].reflectance_factor, kGuideShare * s.weight[i]});
  }
  const auto l1 = linear_solution(FitMethod::kL1, s, target, report);
  const auto l2 = linear_solution(FitMethod::kL2, s, target, report);
  const DeltaEFit fit = deltae_fit(problem, {l1, l2});
  report.optimality_gap = fit.optimality_gap;
  report.status = fit.converged ? "optimal" : "not_converged";
  return fit.x;
}

// Solves for K_D and K_DD.
void solve(const FitOptions& options, const Target& target, const std::vector<double>& exponents,
           const std::vector<int>& seen, const Xyz& white, LobeFit& fit, PaintFitReport& report) {
  const System s = system_of(options, target, exponents, seen);
  const std::vector<Rgb> x = options.method == FitMethod::kDeltaE
                                 ? deltae_solution(s, target, exponents, seen, white, report)
                                 : linear_solution(options.method, s, target, report);
  // The columns were fitted to reflectance factors; the model is in 1/sr.
  fit.diffuse = (1 / M_PI) * x[0];
  for (std::size_t j = 1; j < x.size(); ++j) fit.lobes[seen[j - 1]].directional_diffuse = (1 / M_PI) * x[j];
  std::vector<double> residuals, plain;
  for (int c = 0; c < 3; ++c)
    for (int i = 0; i < s.shape.rows; ++i) {
      double r = target.rows[i].reflectance_factor[c];
      for (std::size_t j = 0; j < x.size(); ++j) r -= s.shape(i, static_cast<int>(j)) * x[j][c];
      residuals.push_back(s.weight[i] * r);
      plain.push_back(r);
    }
  report.objective = norm_of(options.method, residuals);
  report.plain_objective = norm_of(options.method, plain);
}

void compare(const std::vector<LabReading>& readings, const Xyz& white, const LobeFit& fit, PaintFitReport& report) {
  double sum = 0;
  for (const LabReading& reading : readings) {
    const Rgb predicted = flake_reflectance_factor(fit, aspecular_angle_deg(reading.geometry));
    const double de00 = delta_e_2000(reading.lab, lab_from_rgb(predicted, white));
    report.de00_by_geometry.push_back({geometry_name(reading.geometry), de00});
    report.de00_max = std::max(report.de00_max, de00);
    sum += de00;
  }
  report.de00_mean = sum / static_cast<double>(readings.size());
}

}  // namespace

const char* fit_method_name(FitMethod method) {
  switch (method) {
    case FitMethod::kL1:
      return "l1";
    case FitMethod::kL2:
      return "l2";
    case FitMethod::kDeltaE:
      break;
  }
  return "deltae";
}

PaintFitter::PaintFitter(Basis basis, FitOptions options)
    : basis_(std::move(basis)), options_(options), gloss_(basis_.exponents) {}

Result<PaintFit> PaintFitter::fit(const Paint& paint) const {
  const Stopwatch clock;
  PaintFit out;
  LobeFit& fit = out.lobes;
  PaintFitReport& report = out.report;
  fit.basis = basis_.name;
  fit.method = fit_method_name(options_.method);
  for (const double exponent : basis_.exponents) fit.lobes.push_back({exponent, {}, {}});
  if (basis_.mirror) fit.lobes.push_back({std::numeric_limits<double>::infinity(), {}, {}});

  GONIO_ASSIGN(const Xyz white, white_point(condition_of(paint)));
  GONIO_ASSIGN(const Target target, target_rows(paint, options_.target, white, basis_.exponents));
  const std::vector<int> seen = seen_lobes(basis_.exponents, target.first_deg * (M_PI / 180));
  for (std::size_t j = seen.size(); j < basis_.exponents.size(); ++j) report.unseen.push_back(basis_.exponents[j]);
  report.gamut_de00 = target.gamut_de00;
  report.glare_rows = target.glare_rows;
  solve(options_, target, basis_.exponents, seen, white, fit, report);

  std::vector<GlossReading> readings = paint.gloss;
  if (readings.empty() && options_.assumed_gloss_60_gu) readings.push_back({60, *options_.assumed_gloss_60_gu});
  GONIO_ASSIGN(const std::vector<double> misfit, set_gloss(gloss_, readings, fit));
  for (std::size_t i = 0; i < readings.size(); ++i)
    report.gloss.push_back({readings[i].angle_deg, readings[i].gloss_units, misfit[i]});

  std::erase_if(fit.lobes, [](const Lobe& lobe) { return lobe.directional_diffuse == Rgb{} && lobe.gloss == Rgb{}; });
  report.active_lobes = static_cast<int>(fit.lobes.size());
  compare(target.readings, white, fit, report);
  fit.max_de00 = report.de00_max, fit.mean_de00 = report.de00_mean;
  report.time_us = clock.elapsed_s() * 1e6;
  return out;
}

std::vector<Result<PaintFit>> fits(const PaintFitter& fitter, const std::vector<Paint>& paints) {
  std::vector<std::optional<Result<PaintFit>>> slots(paints.size());
  parallel_for(paints.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) slots[i] = fitter.fit(paints[i]);
  });
  std::vector<Result<PaintFit>> results;
  results.reserve(paints.size());
  for (auto& slot : slots) results.push_back(std::move(*slot));
  return results;
}

}  // namespace goniochrome
