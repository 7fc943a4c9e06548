#include "settings.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "fitting.h"
#include "math/cosine_power.h"

namespace goniochrome::tool {

namespace {

// "90", "60:90" or "20:80,60:90".
Result<std::vector<paint::GlossReading>> gloss_readings(const std::string& text) {
  std::vector<paint::GlossReading> readings;
  for (const std::string_view part : split(text, ',')) {
    const auto colon = part.find(':');
    const bool has_angle = colon != std::string_view::npos;
    const auto angle = has_angle ? parse_number(part.substr(0, colon)) : 60;
    const auto units = parse_number(has_angle ? part.substr(colon + 1) : part);
    if (!angle || !units || *units < 0 || *units > 100)
      return usage_error("--gloss \"{}\": give gloss units from 0 to 100, or ANGLE:GU, as in 20:80,60:90", text);
    if (std::ranges::find(brdf::kGlossAngles_deg, *angle) == std::end(brdf::kGlossAngles_deg))
      return usage_error("--gloss \"{}\": gloss meters have 20, 60 and 85 deg", text);
    if (std::ranges::find(readings, *angle, &paint::GlossReading::angle_deg) != readings.end())
      return usage_error("--gloss \"{}\": {} deg is given twice", text, *angle);
    readings.push_back({*angle, *units});
  }
  if (readings.size() == 1 && readings[0].gloss_units == 0) readings.clear();
  return readings;
}

// "auto" is nothing, "none" is paint::kNoCoat.
Result<std::optional<double>> coat_index(const std::string& text) {
  if (text == "auto") return std::optional<double>();
  if (text == "none") return std::optional(paint::kNoCoat);
  const auto index = parse_number(text);
  if (!index || *index < paint::kLeastCoatIndex || *index > paint::kMostCoatIndex)
    return usage_error("--coat \"{}\": give auto, none, or the index of the coat from {} to {}", text,
                       paint::kLeastCoatIndex, paint::kMostCoatIndex);
  return index;
}

// "0,15,30".
Result<std::vector<double>> view_angles(const std::string& text) {
  std::vector<double> angles;
  for (const std::string_view part : split(text, ',')) {
    const auto angle = parse_number(part);
    const bool ascending = angle && (angles.empty() || *angle > angles.back());
    if (!ascending || *angle < 0 || *angle > 90)
      return usage_error(
          "--views \"{}\": give lost, auto, none, or angles from 0 to 90 deg, ascending, as in 0,15,30,45,60,75", text);
    angles.push_back(*angle);
  }
  if (angles.size() < 2) return usage_error("--views \"{}\": give two or more angles, or lost, auto or none", text);
  return angles;
}

std::string list(const std::vector<double>& values) {
  std::string text;
  for (const double v : values) text += fmt::format(" {}", v);
  return text.empty() ? " none" : text;
}

const char* method_plan(fit::FitMethod method) {
  switch (method) {
    case fit::FitMethod::kL1:
      return "least absolute error; about 20 us a paint, leaves an outlier aside";
    case fit::FitMethod::kL2:
      return "least squares; about 15 us a paint, 7-12 % worse in absolute error";
    case fit::FitMethod::kDeltaE:
      break;
  }
  return "least color difference at the readings, started from l1 and l2; some ms a paint";
}

std::string gloss_plan(const std::vector<paint::GlossReading>& readings) {
  std::string text = "as stated, else";
  for (const paint::GlossReading& r : readings) text += fmt::format(" {} GU at {} deg", r.gloss_units, r.angle_deg);
  return readings.empty() ? text + " matt" : text;
}

}  // namespace

Result<fit::FitOptions> fit_options(const Options& options) {
  fit::FitOptions fit;
  fit.method = options.method == "l2"       ? fit::FitMethod::kL2
               : options.method == "deltae" ? fit::FitMethod::kDeltaE
                                            : fit::FitMethod::kL1;
  fit.target = target_kind(options.target);
  fit.perceptual_weights = options.weights == "perceptual";
  fit.most_lobes = options.lobes;
  fit.prune_de00 = options.prune_de00;
  fit.steepest_deg = options.steepest_deg;
  fit.time_limit_s = options.paint_time_limit_s;
  GONIO_ASSIGN(fit.assumed_gloss, gloss_readings(options.gloss));
  GONIO_ASSIGN(fit.coat_index, coat_index(options.coat));
  fit.satin = options.satin == "all"    ? fit::Satin::kAll
              : options.satin == "none" ? fit::Satin::kNone
                                        : fit::Satin::kBySeveral;
  fit.view_sets = options.views == "auto"   ? fit::ViewSets::kWhereNeeded
                  : options.views == "lost" ? fit::ViewSets::kWhereLost
                                            : fit::ViewSets::kNone;
  if (fit.view_sets == fit::ViewSets::kNone && options.views != "none") {
    GONIO_ASSIGN(fit.views_deg, view_angles(options.views));
  }
  return fit;
}

std::string plan(const Options& options, const fit::FitOptions& fit, const formats::Basis& basis) {
  std::vector<double> seen, unseen;
  for (const double e : basis.exponents)
    (math::cos_power(15 * M_PI / 180, e) >= fit::kSeenPart ? seen : unseen).push_back(e);
  std::string text = fmt::format(
      "basis {}: {} lobes{}\n"
      "  flake lobes at a first reading of 15 deg:{}\n"
      "  gloss alone, no reading sees them:{}\n"
      "target {}: {}\n"
      "method {}: {}\n"
      "{}"
      "gloss: {}\n"
      "left out: readings within {} deg of specular; the colors of the working space below 0 (told as gamut_de00)\n",
      basis.name, basis.exponents.size(), basis.mirror ? " and the mirror" : "", list(seen), list(unseen),
      options.target,
      options.target == "curve" ? "quadratic of face, flop and travel; misses 5-angle readings by some dE00"
                                : "the readings, a monotone curve between them at 10 % of their weight",
      options.method, method_plan(fit.method),
      options.illuminant.empty() ? "" : fmt::format("colors: from spectra, under {}\n", options.illuminant),
      gloss_plan(fit.assumed_gloss), fit::kGlareAngle_deg);
  text += fmt::format("coat: {}\n",
                      !fit.coat_index ? "of every paint with gloss, with the index that its gloss asks for"
                      : *fit.coat_index == paint::kNoCoat ? "none"
                                                          : "of every paint, index " + shortest(*fit.coat_index));
  text += fmt::format("measured BRDFs: directions to {} deg from the normal; some ms each\n", fit.steepest_deg);
  if (fit.most_lobes > 0) text += fmt::format("lobes: the best subset of {}\n", fit.most_lobes);
  if (fit.prune_de00 > 0) text += fmt::format("lobes that move no color by dE00 {} are dropped\n", fit.prune_de00);
  if (fit.view_sets == fit::ViewSets::kWhereNeeded)
    text +=
        "views where readings at one aspecular angle differ visibly: a set of weights each, beside the one for all\n";
  if (fit.view_sets != fit::ViewSets::kNone)
    text +=
        "views of all readings where the coat would keep one from being met: a set of weights each, beside the one for "
        "all; twice the time of the fit, and no time in a pixel\n";
  if (!fit.views_deg.empty())
    text += fmt::format("views at{} deg: a set of weights each, beside the one for all\n", list(fit.views_deg));
  return text;
}

}  // namespace goniochrome::tool
