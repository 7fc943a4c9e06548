#include "fit/paint_fit.h"

#include <algorithm>
#include <map>

#include "base/angles.h"
#include "base/clock.h"
#include "base/parallel.h"
#include "brdf/lobe_model.h"
#include "fit/highlight_end.h"
#include "fit/internal/brdf_fit.h"
#include "fit/internal/coat_readings.h"
#include "fit/internal/flake_fit.h"
#include "fit/internal/lobe_choice.h"
#include "fit/internal/target_rows.h"
#include "math/elementary.h"

namespace goniochrome::fit {

namespace {

// Those of `all` that are not in `part`.
std::vector<double> difference(const std::vector<double>& all, const std::vector<double>& part) {
  std::vector<double> rest;
  std::ranges::set_difference(all, part, std::back_inserter(rest));
  return rest;
}

// The columns were fitted to reflectance factors; the model is in 1/sr. `lobes` are those of the basis.
void set_weights(const std::vector<double>& exponents, const color::Rgb* x, color::Rgb& diffuse,
                 std::vector<paint::Lobe>& lobes) {
  diffuse = (1 / kPi) * x[0];
  std::size_t next = 0;
  for (paint::Lobe& lobe : lobes)
    if (next < exponents.size() && lobe.exponent == exponents[next]) lobe.directional_diffuse = (1 / kPi) * x[++next];
}

// The lobes that a fit may use.
std::vector<double> chosen_exponents(const FitOptions& options, const FlakeTarget& target,
                                     const std::vector<double>& seen, const Deadline& deadline) {
  std::vector<double> chosen = seen;
  if (options.most_lobes > 0) chosen = best_exponents(options.method, target, chosen, options.most_lobes, deadline);
  if (options.prune_de00 > 0) chosen = pruned_exponents(options.method, target, chosen, options.prune_de00, deadline);
  return chosen;
}

// The result of a fit for all views.
struct FlakeStart {
  FlakeModel model;              // its lobes
  std::vector<FlakePoint> lost;  // where the rows stand that they meet without a coat and not under it
};

// Solves for K_D and K_DD, for all views.
FlakeStart fit_flake(const FitOptions& options, const FlakeTarget& target, const std::vector<double>& exponents,
                     double first_rad, const Deadline& deadline, PaintFit& out) {
  PaintFitReport& report = out.report;
  const std::vector<double> seen = seen_exponents(exponents, first_rad);
  FlakeModel model{chosen_exponents(options, target, seen, deadline)};
  report.unseen = difference(exponents, seen);
  report.dropped = difference(seen, model.exponents);
  auto [flake, lost] = fit_under_coat(options.method, target, model, deadline);
  set_weights(model.exponents, flake.x.data(), out.lobes.diffuse, out.lobes.lobes);
  report.status = deadline.passed() ? FitStatus::kTimeLimit : flake.status;
  report.objective = flake.objective;
  report.plain_objective = flake.plain_objective;
  report.optimality_gap = flake.optimality_gap;
  return {std::move(model), std::move(lost)};
}

// Adds the K_D and K_DD of these views for the same lobes. Returns where the rows stand that they meet without a coat
// and not under it.
std::vector<FlakePoint> add_views(const FitOptions& options, const FlakeTarget& by_view, FlakeModel model,
                                  const std::vector<double>& views_deg, const Deadline& deadline, PaintFit& out) {
  PaintFitReport& report = out.report;
  model.views_deg = views_deg;
  const auto [each, lost] = fit_under_coat(options.method, by_view, model, deadline);
  out.lobes.views.clear();
  for (std::size_t v = 0; v < model.views_deg.size(); ++v) {
    paint::ViewLobes view{model.views_deg[v], {}, out.lobes.lobes};
    for (paint::Lobe& lobe : view.lobes) lobe.directional_diffuse = {};
    set_weights(model.exponents, &each.x[v * static_cast<std::size_t>(model.columns_per_view())], view.diffuse,
                view.lobes);
    out.lobes.views.push_back(std::move(view));
  }
  if (report.status == FitStatus::kOptimal) report.status = each.status;
  report.optimality_gap = std::max(report.optimality_gap, each.optimality_gap);
  if (deadline.passed()) report.status = FitStatus::kTimeLimit;
  return lost;
}

FlakeTarget flake_target(const FitOptions& options, const Target& target, const color::Xyz& white, double coat_index) {
  FlakeTarget flake{white, {}, {}, {}};
  for (const TargetRow& row : target.rows) flake.rows.push_back(flake_row(row, options, row.importance < 1));
  for (const paint::LabReading& reading : target.readings) flake.readings.push_back(flake_reading(reading, coat_index));
  return flake;
}

// The readings of a paint as the fit has them, with the rows that would be without the coat. Designed colors and curves
// are no readings and have none: a search for the paint of a picture changes its design in small steps, and rows that
// are held for one design and lost for the next would make its way rough.
Result<FlakeTarget> coated_target(const FitOptions& options, const paint::Paint& paint, const Target& target,
                                  const color::Xyz& white, const std::vector<double>& exponents, double coat_index,
                                  bool by_view) {
  FlakeTarget flake = flake_target(options, target, white, coat_index);
  if (coat_index == paint::kNoCoat || !paint.measurement || options.target != paint::TargetCurve::Kind::kMeasured)
    return flake;
  GONIO_ASSIGN(const Target bare, target_rows(paint, options.target, white, exponents, paint::kNoCoat, by_view));
  flake.without_coat = flake_target(options, bare, white, paint::kNoCoat).rows;
  return flake;
}

// The views of the readings, ascending.
std::vector<double> views_of(const std::vector<paint::LabReading>& readings) {
  std::vector<double> views;
  for (const paint::LabReading& reading : readings) views.push_back(named_view_deg(reading.geometry));
  std::ranges::sort(views);
  views.erase(std::ranges::unique(views).begin(), views.end());
  return views;
}

// Those of the differences at the readings that stand at one of `lost`, which tell views apart where `by_view`.
std::vector<GeometryError> errors_lost(const std::vector<paint::LabReading>& readings,
                                       const std::vector<GeometryError>& errors, const std::vector<FlakePoint>& lost,
                                       bool by_view) {
  constexpr double kSame_deg = 1e-5;
  std::vector<GeometryError> told;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const paint::Geometry& geometry = readings[i].geometry;
    if (std::ranges::any_of(lost, [&](const FlakePoint& at) {
          return std::abs(at.aspecular_rad / kDegree - paint::aspecular_angle_deg(geometry)) < kSame_deg &&
                 (!by_view || std::abs(at.view_deg - view_angle_deg(geometry)) < kSame_deg);
        }))
      told.push_back(errors[i]);
  }
  return told;
}

// The color differences at the readings.
std::vector<GeometryError> errors_at(const std::vector<paint::LabReading>& readings, const color::Xyz& white,
                                     const paint::LobeFit& fit) {
  std::vector<GeometryError> errors;
  for (const paint::LabReading& reading : readings) {
    const Vec3 light = paint::directions(reading.geometry).light;
    const double light_deg = math::atan2(math::hypot(light.x, light.y), light.z) / kDegree,
                 view_deg = view_angle_deg(reading.geometry);
    const color::Rgb predicted = brdf::flake_reflectance_factor(
        brdf::at_view(fit, view_deg), paint::aspecular_angle_deg(reading.geometry), light_deg, view_deg);
    errors.push_back({paint::geometry_name(reading.geometry),
                      color::delta_e_2000(reading.lab, color::lab_from_rgb(predicted, white))});
  }
  return errors;
}

double mean_de00(const std::vector<GeometryError>& errors) {
  double sum = 0;
  for (const GeometryError& error : errors) sum += error.de00;
  return errors.empty() ? 0 : sum / static_cast<double>(errors.size());
}

double max_de00(const std::vector<GeometryError>& errors) {
  return errors.empty() ? 0 : std::ranges::max_element(errors, {}, &GeometryError::de00)->de00;
}

// The exponents whose flake may have a sharp part: all but those that the fit dropped. Where the number of lobes is
// limited, those that no sample sees are left out too.
std::vector<double> spike_exponents(const FitOptions& options, const std::vector<double>& exponents,
                                    const PaintFitReport& report) {
  const std::vector<double> left = difference(exponents, report.dropped);
  return options.most_lobes > 0 ? difference(left, report.unseen) : left;
}

bool has_flake(const std::vector<paint::Lobe>& lobes, double exponent) {
  const auto at = std::ranges::find(lobes, exponent, &paint::Lobe::exponent);
  return at != lobes.end() && at->directional_diffuse != color::Rgb{};
}

void scale_gloss(double factor, paint::LobeFit& fit) {
  const auto scale = [&](std::vector<paint::Lobe>& lobes) {
    for (paint::Lobe& lobe : lobes)
      if (!lobe.is_mirror()) lobe.gloss = factor * lobe.gloss;
  };
  scale(fit.lobes);
  for (paint::ViewLobes& view : fit.views) scale(view.lobes);
}

void drop_unused(std::vector<paint::Lobe>& lobes) {
  std::erase_if(lobes, [](const paint::Lobe& lobe) {
    return lobe.directional_diffuse == color::Rgb{} && lobe.gloss == color::Rgb{};
  });
}

}  // namespace

const char* fit_method_name(FitMethod method) {
  constexpr const char* kNames[] = {"l1", "l2", "deltae"};
  return kNames[static_cast<int>(method)];
}

const char* fit_status_name(FitStatus status) {
  constexpr const char* kNames[] = {"optimal", "not_converged", "stalled", "bounded", "time_limit"};
  return kNames[static_cast<int>(status)];
}

PaintFitter::PaintFitter(formats::Basis basis, FitOptions options)
    : basis_(std::move(basis)), options_(std::move(options)), gloss_(basis_.exponents) {}

Result<double> PaintFitter::coat_index(const paint::Paint& paint) const {
  return options_.coat_index ? *options_.coat_index : brdf::coat_index_of_paint(paint, options_.assumed_gloss);
}

// Every lobe of the basis without weight.
PaintFit PaintFitter::started(double coat_index) const {
  PaintFit out;
  out.lobes.coat_index = coat_index;
  out.lobes.basis = basis_.name;
  out.lobes.method = fit_method_name(options_.method);
  for (const double exponent : basis_.exponents) out.lobes.lobes.push_back({exponent, {}, {}});
  if (basis_.mirror) out.lobes.lobes.push_back({paint::kMirrorExponent, {}, {}});
  return out;
}

// Drops unused lobes, and compares with the readings.
void PaintFitter::finish(const std::vector<paint::LabReading>& readings, const color::Xyz& white, PaintFit& out) const {
  paint::LobeFit& fit = out.lobes;
  PaintFitReport& report = out.report;
  for (paint::ViewLobes& view : fit.views) drop_unused(view.lobes);
  drop_unused(fit.lobes);
  report.active_lobes = static_cast<int>(fit.lobes.size());
  report.de00_by_geometry = errors_at(readings, white, fit);
  report.de00_max = max_de00(report.de00_by_geometry);
  report.de00_mean = mean_de00(report.de00_by_geometry);
  fit.max_de00 = report.de00_max, fit.mean_de00 = report.de00_mean;
  if (fit.views.empty()) return;
  paint::LobeFit together = fit;
  together.views.clear();
  const auto errors = errors_at(readings, white, together);
  report.views = ViewFigures{report.de00_mean, mean_de00(errors)};
}

// Readings beyond glare, one angle of incidence after the other. A paint without readings at any other angle has none
// to be predicted from. The figures end where the time of the paint does, because weights that were found in no time
// would tell a disagreement that is not there.
std::vector<IncidenceFigures> PaintFitter::incidences(const paint::Paint& paint, const paint::LobeFit& together,
                                                      const Deadline& deadline) const {
  const auto white = color::white_point(paint::condition_of(paint));
  if (!paint.measurement || !white.ok()) return {};
  std::map<double, std::vector<paint::LabReading>> groups;
  for (const paint::LabReading& row : paint.measurement->rows)
    if (paint::aspecular_angle_deg(row.geometry) >= kGlareAngle_deg) groups[row.geometry.incidence_deg].push_back(row);
  std::vector<IncidenceFigures> figures;
  if (groups.size() < 2) return figures;
  for (const auto& [incidence_deg, here] : groups) {
    paint::Paint others = paint;
    others.appearance.reset();
    others.measurement->spectra.clear();
    std::erase_if(others.measurement->rows,
                  [at = incidence_deg](const paint::LabReading& row) { return row.geometry.incidence_deg == at; });
    const auto alone = fit_all(others, deadline);
    if (deadline.passed()) break;
    if (alone.ok())
      figures.push_back({incidence_deg, here.size(), mean_de00(errors_at(here, *white, together)),
                         mean_de00(errors_at(here, *white, alone->lobes))});
  }
  return figures;
}

Result<PaintFit> PaintFitter::fit(const paint::Paint& paint) const {
  const Deadline deadline(options_.time_limit_s);
  GONIO_ASSIGN(PaintFit all, fit_all(paint, deadline));
  if (options_.by_incidence) all.report.incidences = incidences(paint, all.lobes, deadline);
  return all;
}

// Why the worst reading is not met any better. Where readings, coat and options do not explain it, the paint is fitted
// by color difference too, which gives the largest difference `by_color` that the same lobes can have: the basis is the
// limit only where that comes no closer.
std::string PaintFitter::limit(const std::vector<paint::LabReading>& readings, const color::Xyz& white,
                               const PaintFit& fit, const std::function<double()>& by_color) const {
  const PaintFitReport& report = fit.report;
  const std::string told =
      fit_limit(readings, report.de00_by_geometry, white, fit.lobes.coat_index, !fit.lobes.views.empty());
  if (!told.empty()) return told;
  const auto worst = std::ranges::max_element(report.de00_by_geometry, {}, &GeometryError::de00);
  if (std::ranges::find(report.lost_to_coat, worst->geometry, &GeometryError::geometry) != report.lost_to_coat.end())
    return "its curve under the coat is not one of the basis's lobes, which meet it without the coat";
  if (report.status == FitStatus::kTimeLimit || report.status == FitStatus::kNotConverged)
    return "its fit was not brought to an end";
  if (!report.dropped.empty()) return "lobes of the basis were left out, as the options ask";
  constexpr double kClearlyCloser = 0.9;
  if (options_.method != FitMethod::kDeltaE && fit.lobes.views.empty())
    if (const double closer = by_color(); closer < kClearlyCloser * report.de00_max)
      return fmt::format(
          "{} spreads the error by reflectance: --method deltae comes to dE00 {:.2f} with the same basis",
          fit.lobes.method, closer);
  return "its curve is not one of the basis's lobes";
}

Result<PaintFit> PaintFitter::fit_all(const paint::Paint& paint, const Deadline& deadline) const {
  const Stopwatch clock;
  const std::vector<paint::GlossReading>& readings = paint.gloss.empty() ? options_.assumed_gloss : paint.gloss;
  GONIO_ASSIGN(const double coat, coat_index(paint));
  PaintFit out = started(coat);
  GONIO_ASSIGN(const color::Xyz white, color::white_point(paint::condition_of(paint)));
  GONIO_ASSIGN(const Target target, target_rows(paint, options_.target, white, basis_.exponents, coat));
  GONIO_ASSIGN(const FlakeTarget together,
               coated_target(options_, paint, target, white, basis_.exponents, coat, false));
  const auto [model, lost_by_all] =
      fit_flake(options_, together, basis_.exponents, target.first_deg * kDegree, deadline, out);
  std::vector<FlakePoint> lost = lost_by_all;
  const auto fit_views = [&, &lobes = model](const std::vector<double>& views_deg) -> Result<void> {
    GONIO_ASSIGN(const Target rows, target_rows(paint, options_.target, white, basis_.exponents, coat, true));
    GONIO_ASSIGN(const FlakeTarget by_view, coated_target(options_, paint, rows, white, basis_.exponents, coat, true));
    lost = add_views(options_, by_view, lobes, views_deg, deadline, out);
    return {};
  };
  const Twins twins = twins_of(target.readings);
  const std::vector<double> views_asked =
      options_.view_sets == ViewSets::kWhereNeeded && options_.views_deg.empty() ? twins.views_deg : options_.views_deg;
  if (!views_asked.empty()) GONIO_TRY(fit_views(views_asked));
  const std::vector<double> all_views = views_of(target.readings);
  if (options_.view_sets != ViewSets::kNone && options_.views_deg.empty() && !lost.empty() && all_views.size() > 1 &&
      !deadline.passed()) {
    GONIO_TRY(fit_views(all_views));
    out.report.views_for_coat = true;
  }
  out.report.floor = {twins.apart_de00, twins.sum_de00 / static_cast<double>(target.readings.size()),
                      twins.largest_de00};
  out.report.gamut_de00 = target.gamut_de00;
  out.report.glare_rows = target.glare_rows;

  GONIO_TRY(brdf::set_gloss(gloss_, readings, out.lobes));
  const bool satin = options_.satin == Satin::kAll || (options_.satin == Satin::kBySeveral && readings.size() > 1);
  GONIO_TRY(brdf::set_gloss_views(gloss_, satin ? readings : std::vector<paint::GlossReading>(), out.lobes));
  if (satin && readings.size() > 1) {
    GONIO_ASSIGN(out.report.coat_range, brdf::coat_range(gloss_, readings, out.lobes));
  }
  double gloss_deg = readings.empty() ? brdf::kGlossIncidence_deg : readings.front().angle_deg;
  if (paint.gloss.empty() && !readings.empty()) {
    // The paint will not state this reading, so that its weights are taken to hold at the usual incidence.
    scale_gloss(brdf::coat_fresnel(math::cos(brdf::kGlossIncidence_deg * kDegree), gloss_deg), out.lobes);
    gloss_deg = brdf::kGlossIncidence_deg;
  }
  for (const double angle : brdf::kGlossAngles_deg) {
    const auto stated = std::ranges::find(readings, angle, &paint::GlossReading::angle_deg);
    GONIO_ASSIGN(const brdf::GlossColumns* meter, gloss_.at(angle));
    out.report.gloss.push_back({angle, brdf::gloss_units(gloss_, *meter, out.lobes, gloss_deg),
                                stated == readings.end() ? std::nullopt : std::optional(stated->gloss_units)});
  }
  finish(target.readings, white, out);
  out.report.lost_to_coat = errors_lost(target.readings, out.report.de00_by_geometry, lost, !out.lobes.views.empty());
  if (out.report.de00_max > kVisible_de00)
    out.report.limit = limit(target.readings, white, out, [&]() -> double {
      FitOptions by_color = options_;
      by_color.method = FitMethod::kDeltaE;
      PaintFit other = started(coat);
      fit_flake(by_color, together, basis_.exponents, target.first_deg * kDegree, deadline, other);
      return max_de00(errors_at(target.readings, white, other.lobes));
    });
  out.report.time_us = clock.elapsed_s() * 1e6;
  return out;
}

Result<PaintFit> PaintFitter::fit(const BrdfTarget& brdf) const {
  const Stopwatch clock;
  const Deadline deadline(options_.time_limit_s);
  PaintFit out = started(options_.coat_index.value_or(paint::kNoCoat));
  GONIO_ASSIGN(const color::Xyz white, color::white_point({"D65", 2}));
  GONIO_ASSIGN(const BrdfRows rows, brdf_rows(brdf, white, options_, basis_.exponents));
  static const std::vector<double> kEvery15_deg = {0, 15, 30, 45, 60, 75};
  const FlakeStart flake = fit_flake(options_, rows.flake, basis_.exponents, rows.first_rad, deadline, out);
  const bool every_15 = options_.views_deg.empty() && options_.view_sets == ViewSets::kWhereNeeded;
  const std::vector<double>& views_deg = every_15 ? kEvery15_deg : options_.views_deg;
  if (!views_deg.empty()) add_views(options_, rows.flake, flake.model, views_deg, deadline, out);
  out.report.gamut_de00 = rows.gamut_de00;
  out.report.brdf = BrdfFigures{.fitted = rows.fitted.size(), .glare = rows.glare.size(), .steep = rows.steep};
  add_spike(rows, spike_exponents(options_, basis_.exponents, out.report), out);
  for (paint::ViewLobes& view : out.lobes.views)
    for (std::size_t j = 0; j < view.lobes.size(); ++j) view.lobes[j].gloss = out.lobes.lobes[j].gloss;
  std::erase_if(out.report.unseen, [&](double e) { return has_flake(out.lobes.lobes, e); });
  for (const double angle : brdf::kGlossAngles_deg) {
    GONIO_ASSIGN(const brdf::GlossColumns* meter, gloss_.at(angle));
    const double read = brdf::gloss_units(gloss_, *meter, out.lobes, brdf::kGlossIncidence_deg);
    out.report.gloss.push_back({angle, read, {}});
  }
  const std::vector<paint::LabReading> readings =
      brdf.paint.measurement ? brdf.paint.measurement->rows : std::vector<paint::LabReading>();
  finish(readings, white, out);
  if (out.report.de00_max > kVisible_de00)
    out.report.limit =
        fit_limit(readings, out.report.de00_by_geometry, white, out.lobes.coat_index, !out.lobes.views.empty());
  if (out.report.de00_max > kVisible_de00 && out.report.limit.empty())
    out.report.limit = "the fit weighs all measured directions, not these readings alone";
  compare(rows, white, out);
  if (brdf.paint.measurement) {
    GONIO_ASSIGN(out.report.brdf->from_five_angles, from_five_angles(brdf, deadline));
  }
  out.report.time_us = clock.elapsed_s() * 1e6;
  return out;
}

// Without views, which five readings know nothing of, and without gloss, which no direction beyond glare shows.
Result<FiveAngleFigures> PaintFitter::from_five_angles(const BrdfTarget& brdf, const Deadline& deadline) const {
  const double coat = options_.coat_index.value_or(paint::kNoCoat);
  PaintFit five = started(coat);
  GONIO_ASSIGN(const color::Xyz white, color::white_point(paint::condition_of(brdf.paint)));
  GONIO_ASSIGN(const Target target, target_rows(brdf.paint, options_.target, white, basis_.exponents, coat));
  const FlakeTarget flake = flake_target(options_, target, white, coat);
  fit_flake(options_, flake, basis_.exponents, target.first_deg * kDegree, deadline, five);
  return five_angle_figures(brdf, five.lobes);
}

std::vector<Result<PaintFit>> fits(const PaintFitter& fitter, const std::vector<paint::Paint>& paints) {
  std::vector<std::optional<Result<PaintFit>>> slots(paints.size());
  parallel_for(paints.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) slots[i] = fitter.fit(paints[i]);
  });
  std::vector<Result<PaintFit>> results;
  results.reserve(paints.size());
  for (auto& slot : slots) results.push_back(std::move(*slot));
  return results;
}

}  // namespace goniochrome::fit
