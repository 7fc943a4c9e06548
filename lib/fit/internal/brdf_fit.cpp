#include "fit/internal/brdf_rows.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "brdf/isoline.h"
#include "brdf/lobe_model.h"
#include "fit/internal/brdf_spike.h"
#include "fit/internal/target_rows.h"
#include "math/statistics.h"

namespace goniochrome::fit {

namespace {

// Angles in files are rounded to 1e-6 rad.
constexpr double kSlack_deg = 1e-3;

FlakeRow row_of(const BrdfSample& sample, const color::Rgb& value, double lightness, const FitOptions& options) {
  return {{sample.aspecular_rad, sample.view_deg},
          value,
          options.perceptual_weights ? color::lightness_slope(lightness) : 1,
          false};
}

// The mean color and angle of the flake from one aspecular angle to another; false where nothing was measured there.
bool mean_between(const std::vector<FlakeRow>& rows, double from_deg, double to_deg, double& angle_deg,
                  color::Rgb& color) {
  double count = 0;
  angle_deg = 0, color = {};
  for (const FlakeRow& row : rows) {
    const double angle = row.at.aspecular_rad / kDegree;
    if (angle < from_deg || angle >= to_deg) continue;
    ++count, angle_deg += angle, color += row.value;
  }
  if (count == 0) return false;
  angle_deg /= count, color = (1 / count) * color;
  return true;
}

// The flake within glare is not seen, for the spike covers it: it goes on as from readings. All of these rows together
// weigh about one part in a hundred of the measured ones.
void add_extension(const FitOptions& options, const std::vector<double>& exponents, BrdfRows& rows) {
  constexpr double kShare = 0.004;
  HighlightEnd end;
  if (!mean_between(rows.flake.rows, kGlareAngle_deg, kGlareAngle_deg + 5, end.a_deg, end.at_a) ||
      !mean_between(rows.flake.rows, kGlareAngle_deg + 10, kGlareAngle_deg + 15, end.b_deg, end.at_b))
    return;
  const double importance = kShare * static_cast<double>(rows.fitted.size());
  for (const TargetRow& row :
       extension_to_specular(end, steepest_seen(exponents, rows.first_rad), rows.flake.white, importance))
    rows.flake.rows.push_back({{row.angle_deg * kDegree, row.view_deg},
                               row.reflectance_factor,
                               importance * (options.perceptual_weights ? color::lightness_slope(row.lightness) : 1),
                               true});
}

// The value below which that part of the others lies.
double at_part(std::vector<double> values, double part) {
  const auto rank = static_cast<std::size_t>(part * static_cast<double>(values.size() - 1));
  return math::ranked(std::move(values), rank);
}

std::vector<double> relative_errors(const BrdfRows& rows, const paint::LobeFit& fit) {
  std::vector<double> errors;
  for (const BrdfSample& sample : rows.fitted) {
    const double size = length(sample.value);
    if (size > 0) errors.push_back(length(shown_at(fit, sample) - sample.value) / size);
  }
  return errors.empty() ? std::vector<double>{0} : errors;
}

std::vector<double> color_errors(const BrdfRows& rows, const color::Xyz& white, const paint::LobeFit& fit) {
  std::vector<double> errors;
  for (const BrdfSample& sample : rows.fitted)
    errors.push_back(color::delta_e_2000(color::lab_from_rgb(sample.value, white),
                                         color::lab_from_rgb(shown_at(fit, sample), white)));
  return errors;
}

// The aspecular angle at which light at 45 deg shows, in plane, the flakes that mirror the light of a sample to its
// viewer: those whose normal is as far from the coat's, seen in the coat. goniochrome-theory(7), ISOCHROMATIC LINES
double aspecular_of_flakes_deg(const BrdfSample& sample) {
  const paint::DirectionPair pair = directions_of(sample);
  const double flake = brdf::flake_angles(pair.light, pair.view, brdf::kCoatIndex).flake_rad;
  const double light_in_coat = std::asin(std::sin(45 * kDegree) / brdf::kCoatIndex);
  const double sine = brdf::kCoatIndex * std::sin(2 * flake - light_in_coat);
  return 45 + std::asin(std::clamp(sine, -1.0, 1.0)) / kDegree;
}

}  // namespace

FiveAngleFigures five_angle_figures(const BrdfTarget& brdf, const paint::LobeFit& lobes) {
  constexpr double kSteepest_deg = 60 + kSlack_deg;
  std::vector<double> by_aspecular, by_flake;
  for (const BrdfSample& sample : brdf.samples) {
    const double size = length(sample.value);
    if (std::max(sample.light_deg, sample.view_deg) > kSteepest_deg ||
        sample.aspecular_rad < kGlareAngle_deg * kDegree || size <= 0)
      continue;
    const auto error = [&](double angle_deg) {
      return length(brdf::flake_reflectance_factor(lobes, angle_deg) - sample.value) / size;
    };
    by_aspecular.push_back(error(sample.aspecular_rad / kDegree));
    by_flake.push_back(error(aspecular_of_flakes_deg(sample)));
  }
  if (by_flake.empty()) return {};
  return {by_flake.size(), at_part(by_aspecular, 0.5), at_part(by_flake, 0.5)};
}

Result<BrdfRows> brdf_rows(const BrdfTarget& brdf, const color::Xyz& white, const FitOptions& options,
                           const std::vector<double>& exponents) {
  BrdfRows rows;
  rows.flake.white = white;
  rows.first_rad = kPi;
  for (const BrdfSample& sample : brdf.samples) {
    if (std::max(sample.light_deg, sample.view_deg) > options.steepest_deg + kSlack_deg) {
      ++rows.steep;
      continue;
    }
    if (sample.aspecular_rad < kGlareAngle_deg * kDegree) {
      rows.glare.push_back(sample);
      continue;
    }
    const color::Lab lab = color::lab_from_rgb(sample.value, white);
    color::Rgb value = sample.value;
    for (int c = 0; c < 3; ++c) value[c] = std::max(value[c], 0.0);
    if (value != sample.value)
      rows.gamut_de00 = std::max(rows.gamut_de00, color::delta_e_2000(lab, color::lab_from_rgb(value, white)));
    rows.flake.rows.push_back(row_of(sample, value, lab.L, options));
    if (options.method == FitMethod::kDeltaE) rows.flake.readings.push_back({rows.flake.rows.back().at, lab});
    rows.fitted.push_back(sample);
    rows.first_rad = std::min(rows.first_rad, sample.aspecular_rad);
  }
  if (rows.fitted.empty())
    return input_error("no direction {} deg or more from specular and at most {} deg from the normal", kGlareAngle_deg,
                       options.steepest_deg);
  add_extension(options, exponents, rows);
  return rows;
}

void compare(const BrdfRows& rows, const color::Xyz& white, PaintFit& out) {
  BrdfFigures& figures = *out.report.brdf;
  const std::vector<double> relative = relative_errors(rows, out.lobes);
  figures.relative_error_median = at_part(relative, 0.5);
  figures.relative_error_p95 = at_part(relative, 0.95);
  const std::vector<double> de00 = color_errors(rows, white, out.lobes);
  figures.de00_median = at_part(de00, 0.5);
  figures.de00_p95 = at_part(de00, 0.95);
  if (out.lobes.views.empty()) return;
  paint::LobeFit together = out.lobes;
  together.views.clear();
  out.report.views = ViewFigures{math::mean(de00), math::mean(color_errors(rows, white, together))};
}

}  // namespace goniochrome::fit
