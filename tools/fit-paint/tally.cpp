#include "tally.h"

#include <algorithm>
#include <functional>

namespace goniochrome::tool {

namespace {

constexpr int kWarningsShown = 10;
constexpr std::size_t kWorstShown = 5;
constexpr double kBad_de00 = 2;  // the summary names paints that are worse
constexpr double kSpreadStep = 0.01;

Json by_geometry(const std::vector<fit::GeometryError>& errors) {
  Json object = Json::object();
  for (const fit::GeometryError& g : errors) {
    // Two readings of one geometry: the worse one counts.
    const double before = object.value(g.geometry, 0.0);
    object[g.geometry] = json_number(std::max(before, g.de00));
  }
  return object;
}

Json gloss_of(const std::vector<fit::GlossMisfit>& gloss) {
  Json array = Json::array();
  for (const fit::GlossMisfit& g : gloss) {
    Json reading = {{"angle_deg", g.angle_deg}, {"simulated_gu", json_number(g.simulated_gu)}};
    if (g.stated_gu) {
      reading["stated_gu"] = *g.stated_gu;
      reading["misfit_gu"] = json_number(g.simulated_gu - *g.stated_gu);
    }
    array.push_back(std::move(reading));
  }
  return array;
}

Json range_of(const brdf::CoatRange& range) {
  const auto coat = [](const brdf::RoughCoat& of) {
    return Json{{"k", json_number(of.k)}, {"slope", json_number(of.slope)}, {"haze", json_number(of.haze)}};
  };
  return {{"slopes", range.probable.slopes == brdf::Slopes::kGgx ? "ggx" : "gaussian"},
          {"least_haze", coat(range.least_haze)},
          {"probable", coat(range.probable)},
          {"most_haze", coat(range.most_haze)}};
}

Json incidences_of(const std::vector<fit::IncidenceFigures>& incidences) {
  Json array = Json::array();
  for (const fit::IncidenceFigures& figures : incidences)
    array.push_back({{"incidence_deg", figures.incidence_deg},
                     {"readings", figures.readings},
                     {"de00_mean", json_number(figures.de00_mean)},
                     {"predicted_de00_mean", json_number(figures.predicted_de00_mean)}});
  return array;
}

Json report_of(const paint::Paint& paint, const fit::PaintFit& fit) {
  const fit::PaintFitReport& r = fit.report;
  Json report = {{"name", paint.name},
                 {"method", fit.lobes.method},
                 {"status", fit::fit_status_name(r.status)},
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
                 {"lost_to_coat", by_geometry(r.lost_to_coat)},
                 {"views_for_coat", r.views_for_coat},
                 {"limit", r.limit},
                 {"floor_de00_mean", json_number(r.floor.de00_mean)},
                 {"apart_de00", json_number(r.floor.apart_de00)},
                 {"gamut_de00", json_number(r.gamut_de00)},
                 {"glare_rows", r.glare_rows},
                 {"gloss", gloss_of(r.gloss)}};
  if (r.coat_range) report["coat_range"] = range_of(*r.coat_range);
  if (r.brdf)
    report["brdf"] = {{"directions", r.brdf->fitted},
                      {"glare_directions", r.brdf->glare},
                      {"steep_directions", r.brdf->steep},
                      {"relative_error_median", json_number(r.brdf->relative_error_median)},
                      {"relative_error_p95", json_number(r.brdf->relative_error_p95)},
                      {"de00_median", json_number(r.brdf->de00_median)},
                      {"de00_p95", json_number(r.brdf->de00_p95)},
                      {"spike_albedo_45", json_number(r.brdf->spike_albedo_45)}};
  if (r.brdf && r.brdf->albedo_error) report["brdf"]["albedo_error"] = json_number(*r.brdf->albedo_error);
  if (r.brdf && r.brdf->from_five_angles)
    report["brdf"]["from_five_angles"] = {{"directions", r.brdf->from_five_angles->directions},
                                          {"by_aspecular", json_number(r.brdf->from_five_angles->by_aspecular)},
                                          {"by_flake", json_number(r.brdf->from_five_angles->by_flake)}};
  if (!r.incidences.empty()) report["incidences"] = incidences_of(r.incidences);
  if (r.views)
    report["views"] = {{"de00_mean", json_number(r.views->de00_mean)},
                       {"de00_mean_without", json_number(r.views->de00_mean_without)},
                       {"gain_de00", json_number(r.views->gain_de00())}};
  return report;
}

double p95(const Spread& spread) {
  return spread.all_but(0.05 * static_cast<double>(spread.count())) + kSpreadStep;
}

}  // namespace

void Spread::add(double de00) {
  constexpr double kLargest = 1000;
  const auto step = static_cast<std::size_t>(std::clamp(de00, 0.0, kLargest) / kSpreadStep);
  if (steps_.size() <= step) steps_.resize(step + 1, 0);
  ++steps_[step], ++count_, sum_ += de00;
}

double Spread::all_but(double most) const {
  std::size_t above = 0;
  for (std::size_t step = steps_.size(); step > 0; --step) {
    above += steps_[step - 1];
    if (static_cast<double>(above) > most) return kSpreadStep * static_cast<double>(step - 1);
  }
  return 0;
}

Tally::Tally(const Options& options, cli::Session& session) : options_(options), session_(session) {
  session.begin_list("paints");
}

void Tally::add_worst(const paint::Paint& paint, const fit::PaintFitReport& r) {
  if (r.de00_by_geometry.empty()) return;
  const auto at = std::ranges::max_element(r.de00_by_geometry, {}, &fit::GeometryError::de00);
  const auto place = std::ranges::upper_bound(worst_, at->de00, std::greater<>(), &Bad::de00);
  worst_.insert(place, {paint.name, at->geometry, r.limit, at->de00});
  if (worst_.size() > kWorstShown) worst_.pop_back();
}

void Tally::add_range(const paint::Paint& paint, const brdf::CoatRange& range) {
  ++open_coats_;
  const double factor = range.most_haze.haze / range.least_haze.haze;
  if (open_coats_ > 1 && factor <= widest_.most_haze.haze / widest_.least_haze.haze) return;
  widest_ = range, widest_name_ = paint.name;
}

void Tally::add(const paint::Paint& paint, const fit::PaintFit& fit) {
  const fit::PaintFitReport& r = fit.report;
  ++fitted_;
  not_converged_ += r.status == fit::FitStatus::kNotConverged;
  stalled_ += r.status == fit::FitStatus::kStalled;
  stopped_ += r.status == fit::FitStatus::kTimeLimit;
  for (const fit::GeometryError& error : r.de00_by_geometry) errors_.add(error.de00);
  add_worst(paint, r);
  contradicting_ += r.floor.apart_de00 > fit::kVisible_de00;
  for (const fit::GeometryError& lost : r.lost_to_coat)
    ++lost_to_coat_, largest_lost_ = std::max(largest_lost_, lost.de00);
  by_views_ += r.views_for_coat;
  sum_floor_ += r.floor.de00_mean * static_cast<double>(r.de00_by_geometry.size());
  for (const double floor : r.floor.largest_de00) floors_.add(floor);
  if (r.views) sum_gain_ += r.views->gain_de00();
  if (r.coat_range) add_range(paint, *r.coat_range);
  if (r.brdf) {
    ++measured_, sum_relative_ += r.brdf->relative_error_median;
    if (r.brdf->albedo_error) ++resolved_, sum_misplaced_ += *r.brdf->albedo_error;
  }
  if (r.brdf && r.brdf->from_five_angles) ++predicted_, sum_five_ += r.brdf->from_five_angles->by_flake;
  session_.add("paints", [&] { return report_of(paint, fit); });
}

void Tally::add_failure(const paint::Paint& paint, const std::string& where, const std::string& message) {
  if (++failed_ <= kWarningsShown)
    session_.warn(fmt::format("{}: paint \"{}\" is passed on unfitted: {}", where, paint.name, message));
  session_.add("paints", [&] {
    return Json{{"name", paint.name}, {"method", options_.method}, {"status", "failed"}, {"message", message}};
  });
}

std::string Tally::summary() const {
  const double rate = fit_s_ > 0 ? static_cast<double>(done()) / fit_s_ : 0;
  std::string line = fmt::format("{}: {} paints by {}", session_.tool(), fitted_, options_.method);
  if (!worst_.empty()) {
    const Bad& worst = worst_.front();
    line +=
        fmt::format(", dE00 mean {:.2f}, 95 % below {:.2f}, worst {:.2f} ({} at {}{}{})", errors_.mean(), p95(errors_),
                    worst.de00, worst.name, worst.geometry, worst.limit.empty() ? "" : ": ", worst.limit);
  }
  if (measured_ > 0)
    line += fmt::format(", {} measured BRDFs with a median relative error of {:.3f}", measured_,
                        sum_relative_ / static_cast<double>(measured_));
  if (resolved_ > 0)
    line += fmt::format(", {:.3f} of the light misplaced", sum_misplaced_ / static_cast<double>(resolved_));
  if (predicted_ > 0)
    line +=
        fmt::format(", five angles predict those to 60 deg with {:.3f}", sum_five_ / static_cast<double>(predicted_));
  if (views_asked(options_))
    line +=
        fmt::format(", the views gain dE00 {:.2f}", sum_gain_ / static_cast<double>(std::max<std::size_t>(fitted_, 1)));
  if (not_converged_ > 0) line += fmt::format(", {} not converged", not_converged_);
  if (stalled_ > 0) line += fmt::format(", {} stalled", stalled_);
  if (stopped_ > 0) line += fmt::format(", {} stopped by the time limit", stopped_);
  if (failed_ > 0) line += fmt::format(", {} unfitted", failed_);
  return line + fmt::format("; {:.0f} fits/s", rate);
}

// The least mean, and the least difference that 95 % of the readings can be below. Of two readings that contradict each
// other, no fit meets both: the worse one is off by at least the smallest value that the larger difference can have.
std::string Tally::floor() const {
  const auto readings = static_cast<double>(std::max<std::size_t>(errors_.count(), 1));
  return fmt::format("dE00 mean {:.2f}, 95 % below {:.2f}", sum_floor_ / readings, floors_.all_but(0.05 * readings));
}

cli::Verdict Tally::finish() {
  if (failed_ > kWarningsShown) session_.warn(fmt::format("{} more paints unfitted", failed_ - kWarningsShown));
  const auto readings = static_cast<double>(std::max<std::size_t>(errors_.count(), 1));
  Json& results = session_.results();
  results["fits_per_s"] = fit_s_ > 0 ? static_cast<double>(done()) / fit_s_ : 0;
  results["fitted"] = fitted_;
  results["failed"] = failed_;
  results["de00_mean"] = errors_.mean();
  results["de00_p95"] = p95(errors_);
  results["contradicting"] = contradicting_;
  results["lost_to_coat"] = lost_to_coat_;
  results["views_for_coat"] = by_views_;
  results["floor_de00_mean"] = sum_floor_ / readings;
  results["floor_de00_p95"] = floors_.all_but(0.05 * readings);
  results["worst"] = Json::array();
  for (const Bad& bad : worst_)
    results["worst"].push_back(
        {{"name", bad.name}, {"geometry", bad.geometry}, {"de00", bad.de00}, {"limit", bad.limit}});

  if (done() == 0) session_.warn("the input holds no paints: nothing was fitted");
  const bool negative = done() == 0 || failed_ > 0 || not_converged_ > 0 || stopped_ > 0;
  negative ? session_.say_verdict(summary()) : session_.say(summary());
  for (std::size_t k = 1; k < worst_.size() && worst_[k].de00 > kBad_de00; ++k)
    session_.say(fmt::format("  then {:.2f} ({} at {}: {})", worst_[k].de00, worst_[k].name, worst_[k].geometry,
                             worst_[k].limit));
  if (contradicting_ > 0 && !views_asked(options_))
    session_.say(
        fmt::format("{}: {} paints contradict themselves at one aspecular angle: no weights for all views come "
                    "below {}; --views auto does",
                    session_.tool(), contradicting_, floor()));
  if (by_views_ > 0)
    session_.say(
        fmt::format("{}: {} paints have weights for the views of their readings, as no weights for all views meet "
                    "under the coat what lobes meet without it; --views none leaves them out",
                    session_.tool(), by_views_));
  if (lost_to_coat_ > 0)
    session_.say(fmt::format(
        "{}: {} readings that lobes meet without a coat are off by up to dE00 {:.2f} under it{}", session_.tool(),
        lost_to_coat_, largest_lost_,
        options_.views == "none" ? ", where no weights for all views meet them; --views lost meets them" : ""));
  if (open_coats_ > 0)
    session_.say(fmt::format(
        "{}: the gloss readings of {} paints leave open how wide the haze of their coats is; that of {} may have "
        "slopes from {:.2f} to {:.2f}, and {:.2f} is drawn",
        session_.tool(), open_coats_, widest_name_, widest_.least_haze.haze, widest_.most_haze.haze,
        widest_.probable.haze));
  if (stopped_ > 0) return cli::Verdict::kStopped;
  return negative ? cli::Verdict::kNegative : cli::Verdict::kDone;
}

}  // namespace goniochrome::tool
