#include "fit/internal/brdf_fit.h"

#include <algorithm>

#include "base/angles.h"
#include "brdf/isoline.h"
#include "brdf/lobe_model.h"
#include "fit/internal/target_rows.h"
#include "math/cosine_power.h"
#include "math/elementary.h"
#include "math/least_squares.h"
#include "math/statistics.h"

namespace goniochrome::fit {

namespace {

// Angles in files are rounded to 1e-6 rad.
constexpr double kSlack_deg = 1e-3;

// A sharp lobe falls to half its peak or less where glare ends.
constexpr double kSharpPart = 0.5;

// Where every sharp lobe gives less than this part of its peak, a direction says nothing of them.
constexpr double kReach = 0.01;

// The factor of a gloss weight of 1 there.
double coat_scale(const BrdfSample& sample) {
  return brdf::coat_fresnel(half_angle_cosine(sample)) / math::cos(sample.light_deg * kDegree);
}

// The share of the base's light that a coat leaves there.
double passages(const BrdfSample& sample, double coat_index) {
  return brdf::coat_passages(coat_index, math::cos(sample.light_deg * kDegree), math::cos(sample.view_deg * kDegree));
}

// The color of the lobes there, gloss included: reflectance factors of the working space.
color::Rgb shown_at(const paint::LobeFit& lobes, const BrdfSample& sample) {
  return kPi * brdf::brdf_by_angles(lobes, sample.aspecular_rad, sample.view_deg, passages(sample, lobes.coat_index),
                                    coat_scale(sample));
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

// Within glare the spike covers the flake, so the flake goes on toward specular as it does from readings. All of these
// rows together weigh about one part in a hundred of the measured ones.
void add_extension(const FitOptions& options, const std::vector<double>& exponents, BrdfRows& rows) {
  constexpr double kShare = 0.004;
  HighlightEnd end;
  if (!mean_between(rows.flake.rows, kGlareAngle_deg, kGlareAngle_deg + 5, end.a_deg, end.at_a) ||
      !mean_between(rows.flake.rows, kGlareAngle_deg + 10, kGlareAngle_deg + 15, end.b_deg, end.at_b))
    return;
  const double importance = kShare * static_cast<double>(rows.fitted.size());
  for (const TargetRow& row : extension_to_specular(end, steepest_seen(exponents, rows.first_rad), rows.flake.white,
                                                    importance, options.coat_index.value_or(paint::kNoCoat)))
    rows.flake.rows.push_back(flake_row(row, options, true));
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
    errors.push_back(color_difference(sample.value, shown_at(fit, sample), white));
  return errors;
}

// The aspecular angle at which light at 45 deg shows, in plane, the flakes that mirror the light of a sample to its
// viewer: those whose normal is as far from the coat's, seen in the coat.
// goniochrome-interference(7), "ISOCHROMATIC LINES"
double aspecular_of_flakes_deg(const BrdfSample& sample) {
  const paint::DirectionPair pair = directions_of(sample);
  const double flake = brdf::flake_angles(pair.light, pair.view, brdf::kCoatIndex).flake_rad;
  const double light_in_coat = math::asin(math::sin(45 * kDegree) / brdf::kCoatIndex);
  const double sine = brdf::kCoatIndex * math::sin(2 * flake - light_in_coat);
  return 45 + math::asin(std::clamp(sine, -1.0, 1.0)) / kDegree;
}

// Positions of the sharp lobes, ascending.
std::vector<std::size_t> sharp_lobes(const std::vector<paint::Lobe>& lobes) {
  std::vector<std::size_t> sharp;
  for (std::size_t j = 0; j < lobes.size(); ++j)
    if (!lobes[j].is_mirror() && math::cos_power(kGlareAngle_deg * kDegree, lobes[j].exponent) <= kSharpPart)
      sharp.push_back(j);
  return sharp;
}

// The directions that some sharp lobe reaches.
std::vector<BrdfSample> samples_reached(const BrdfRows& rows, double widest_exponent) {
  std::vector<BrdfSample> reached = rows.glare;
  for (const BrdfSample& sample : rows.fitted)
    if (math::cos_power(sample.aspecular_rad, widest_exponent) >= kReach) reached.push_back(sample);
  return reached;
}

// Gray columns stand in the rows of all three channels, colored ones in those of theirs.
struct Columns {
  std::vector<std::size_t> gray, colored;  // positions of lobes
  int count() const { return static_cast<int>(gray.size() + 3 * colored.size()); }
  int colored_column(int channel, std::size_t j) const {
    return static_cast<int>(gray.size() + static_cast<std::size_t>(channel) * colored.size() + j);
  }
};

math::NonNegativeFit solved(const BrdfRows& rows, const std::vector<BrdfSample>& samples, const Columns& columns,
                            const paint::LobeFit& flake) {
  const int n = static_cast<int>(samples.size());
  math::Matrix m(3 * n, columns.count());
  std::vector<double> left(static_cast<std::size_t>(3 * n)), power(flake.lobes.size());
  for (int i = 0; i < n; ++i) {
    const BrdfSample& sample = samples[static_cast<std::size_t>(i)];
    const double weight = color::lightness_slope(color::lab_from_rgb(sample.value, rows.flake.white).L);
    const double coat = coat_scale(sample), base = passages(sample, flake.coat_index);
    const color::Rgb rest = sample.value - shown_at(flake, sample);
    const double log_cos = math::log_cosine(sample.aspecular_rad);
    for (std::size_t j = 0; j < flake.lobes.size(); ++j)
      power[j] = weight * math::power_of_cosine(log_cos, flake.lobes[j].exponent);
    for (int c = 0; c < 3; ++c) {
      const int row = c * n + i;
      left[static_cast<std::size_t>(row)] = weight * rest[c];
      for (std::size_t j = 0; j < columns.gray.size(); ++j) m(row, static_cast<int>(j)) = coat * power[columns.gray[j]];
      for (std::size_t j = 0; j < columns.colored.size(); ++j)
        m(row, columns.colored_column(c, j)) = base * power[columns.colored[j]];
    }
  }
  return math::nnls(m, left);
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
      return length(brdf::flake_reflectance_factor(lobes, angle_deg, sample.light_deg, sample.view_deg) -
                    sample.value) /
             size;
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
    const double base = passages(sample, options.coat_index.value_or(paint::kNoCoat));
    rows.gamut_de00 = std::max(rows.gamut_de00, gamut_loss(lab, sample.value, white));
    rows.flake.rows.push_back({{sample.aspecular_rad, sample.view_deg},
                               (1 / base) * non_negative(sample.value),
                               base * (options.perceptual_weights ? color::lightness_slope(lab.L) : 1),
                               false});
    if (options.method == FitMethod::kDeltaE) rows.flake.readings.push_back({rows.flake.rows.back().at, lab, base});
    rows.fitted.push_back(sample);
    rows.first_rad = std::min(rows.first_rad, sample.aspecular_rad);
  }
  if (rows.fitted.empty())
    return input_error("no direction {} deg or more from specular and at most {} deg from the normal", kGlareAngle_deg,
                       options.steepest_deg);
  if (options.method == FitMethod::kDeltaE && brdf.paint.measurement)
    for (const paint::LabReading& reading : brdf.paint.measurement->rows)
      rows.flake.usual.push_back(flake_reading(reading, options.coat_index.value_or(paint::kNoCoat)));
  add_extension(options, exponents, rows);
  return rows;
}

void add_spike(const BrdfRows& rows, const std::vector<double>& flake_too, PaintFit& out) {
  std::vector<paint::Lobe>& lobes = out.lobes.lobes;
  Columns columns{sharp_lobes(lobes), {}};
  if (columns.gray.empty() || rows.glare.empty()) return;
  for (const std::size_t j : columns.gray)
    if (std::ranges::binary_search(flake_too, lobes[j].exponent)) columns.colored.push_back(j);
  const auto samples = samples_reached(rows, lobes[columns.gray.front()].exponent);
  const math::NonNegativeFit spike = solved(rows, samples, columns, out.lobes);

  const auto add_flake = [&](std::vector<paint::Lobe>& to) {
    for (std::size_t j = 0; j < columns.colored.size(); ++j)
      for (int c = 0; c < 3; ++c)
        to[columns.colored[j]].directional_diffuse[c] +=
            spike.x[static_cast<std::size_t>(columns.colored_column(c, j))] / kPi;
  };
  add_flake(lobes);
  for (paint::ViewLobes& view : out.lobes.views) add_flake(view.lobes);
  double albedo = 0;
  for (std::size_t j = 0; j < columns.gray.size(); ++j) {
    paint::Lobe& lobe = lobes[columns.gray[j]];
    const double weight = spike.x[j] / kPi;
    lobe.gloss = {weight, weight, weight};
    // Sharp lobes reflect 2 pi/(E+1) times the weight, since the cosines of light and viewer are equal across them.
    albedo += 2 * kPi / (lobe.exponent + 1) * weight;
  }
  out.report.brdf->spike_albedo_45 = albedo;
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
