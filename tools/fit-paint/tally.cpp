#include "tally.h"

#include <algorithm>

namespace goniochrome {

namespace {

constexpr int kWarningsShown = 10;

Json by_geometry(const std::vector<GeometryError>& errors) {
  Json object = Json::object();
  for (const GeometryError& g : errors) {
    // Two readings of one geometry: the worse one counts.
    const double before = object.value(g.geometry, 0.0);
    object[g.geometry] = json_number(std::max(before, g.de00));
  }
  return object;
}

Json gloss_of(const std::vector<GlossMisfit>& gloss) {
  Json array = Json::array();
  for (const GlossMisfit& g : gloss) {
    Json reading = {{"angle_deg", g.angle_deg}, {"simulated_gu", json_number(g.simulated_gu)}};
    if (g.stated_gu) {
      reading["stated_gu"] = *g.stated_gu;
      reading["misfit_gu"] = json_number(g.simulated_gu - *g.stated_gu);
    }
    array.push_back(std::move(reading));
  }
  return array;
}

Json report_of(const Paint& paint, const PaintFit& fit) {
  const PaintFitReport& r = fit.report;
  Json report = {{"name", paint.name},
                 {"method", fit.lobes.method},
                 {"status", fit_status_name(r.status)},
                 {"time_us", r.time_us},
                 {"objective", json_number(r.objective)},
                 {"plain_objective", json_number(r.plain_objective)},
                 {"optimality_gap", json_number(r.optimality_gap)},
                 {"active_lobes", r.active_lobes},
                 {"unseen_exponents", r.unseen},
                 {"dropped_exponents", r.dropped},
                 {"de00_max", json_number(r.de00_max)},
                 {"de00_mean", json_number(r.de00_mean)},
                 {"de00_by_geometry", by_geometry(r.de00_by_geometry)},
                 {"limit", r.limit},
                 {"gamut_de00", json_number(r.gamut_de00)},
                 {"glare_rows", r.glare_rows},
                 {"gloss", gloss_of(r.gloss)}};
  if (r.brdf)
    report["brdf"] = {{"directions", r.brdf->fitted},
                      {"glare_directions", r.brdf->glare},
                      {"steep_directions", r.brdf->steep},
                      {"relative_error_median", json_number(r.brdf->relative_error_median)},
                      {"relative_error_p95", json_number(r.brdf->relative_error_p95)},
                      {"de00_median", json_number(r.brdf->de00_median)},
                      {"de00_p95", json_number(r.brdf->de00_p95)},
                      {"spike_albedo_45", json_number(r.brdf->spike_albedo_45)}};
  if (r.views)
    report["views"] = {{"de00_mean", json_number(r.views->de00_mean)},
                       {"de00_mean_without", json_number(r.views->de00_mean_without)},
                       {"gain_de00", json_number(r.views->gain_de00())}};
  return report;
}

}  // namespace

Tally::Tally(const Options& options, cli::Session& session) : options_(options), session_(session) {
  if (!options.common.report.empty()) session.results()["paints"] = Json::array();
}

void Tally::add(const Paint& paint, const PaintFit& fit) {
  const PaintFitReport& r = fit.report;
  ++fitted_;
  not_converged_ += r.status == FitStatus::kNotConverged;
  stopped_ += r.status == FitStatus::kTimeLimit;
  sum_mean_ += r.de00_mean;
  if (r.views) sum_gain_ += r.views->gain_de00();
  if (r.brdf) ++measured_, sum_relative_ += r.brdf->relative_error_median;
  if (!r.de00_by_geometry.empty() && (worst_.empty() || r.de00_max > worst_de00_)) {
    worst_de00_ = r.de00_max;
    const auto worst = std::ranges::max_element(r.de00_by_geometry, {}, &GeometryError::de00);
    worst_ = fmt::format("{} at {}{}{}", paint.name, worst->geometry, r.limit.empty() ? "" : ": ", r.limit);
  }
  if (!options_.common.report.empty()) session_.results()["paints"].push_back(report_of(paint, fit));
}

void Tally::add_failure(const Paint& paint, const std::string& where, const std::string& message) {
  if (++failed_ <= kWarningsShown)
    session_.warn(fmt::format("{}: paint \"{}\" is passed on unfitted: {}", where, paint.name, message));
  if (!options_.common.report.empty())
    session_.results()["paints"].push_back(
        {{"name", paint.name}, {"method", options_.method}, {"status", "failed"}, {"message", message}});
}

cli::Verdict Tally::finish() {
  if (failed_ > kWarningsShown) session_.warn(fmt::format("{} more paints unfitted", failed_ - kWarningsShown));
  const double rate = fit_s_ > 0 ? static_cast<double>(done()) / fit_s_ : 0;
  session_.results()["fits_per_s"] = rate;
  session_.results()["fitted"] = fitted_;
  session_.results()["failed"] = failed_;
  const auto count = static_cast<double>(std::max<std::size_t>(fitted_, 1));
  std::string line = fmt::format("{}: {} paints by {}", session_.tool(), fitted_, options_.method);
  if (!worst_.empty())
    line += fmt::format(", dE00 mean {:.2f}, worst {:.2f} ({})", sum_mean_ / count, worst_de00_, worst_);
  if (measured_ > 0)
    line += fmt::format(", {} measured BRDFs with a median relative error of {:.3f}", measured_,
                        sum_relative_ / static_cast<double>(measured_));
  if (!options_.views_deg.empty()) line += fmt::format(", the views gain dE00 {:.2f}", sum_gain_ / count);
  if (not_converged_ > 0) line += fmt::format(", {} not converged", not_converged_);
  if (stopped_ > 0) line += fmt::format(", {} stopped by the time limit", stopped_);
  if (failed_ > 0) line += fmt::format(", {} unfitted", failed_);
  session_.say(line + fmt::format("; {:.0f} fits/s", rate));
  if (stopped_ > 0) return cli::Verdict::kStopped;
  return failed_ > 0 || not_converged_ > 0 ? cli::Verdict::kNegative : cli::Verdict::kDone;
}

}  // namespace goniochrome
