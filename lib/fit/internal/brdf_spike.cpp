#include "fit/internal/brdf_spike.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "brdf/lobe_model.h"
#include "math/cosine_power.h"

namespace goniochrome::fit {

namespace {

// A sharp lobe falls to half its peak or less where glare ends.
constexpr double kSharpPart = 0.5;

// Where every sharp lobe gives less than this part of its peak, a direction says nothing of them.
constexpr double kReach = 0.01;

// What a gloss weight of 1 counts there.
double coat_scale(const BrdfSample& sample) {
  return brdf::coat_fresnel(half_angle_cosine(sample)) / std::cos(sample.light_deg * kDegree);
}

// Positions of the sharp lobes, ascending.
std::vector<std::size_t> sharp_lobes(const std::vector<paint::Lobe>& lobes) {
  std::vector<std::size_t> sharp;
  for (std::size_t j = 0; j < lobes.size(); ++j)
    if (std::isfinite(lobes[j].exponent) && math::cos_power(kGlareAngle_deg * kDegree, lobes[j].exponent) <= kSharpPart)
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
    const double coat = coat_scale(sample);
    const color::Rgb rest = sample.value - shown_at(flake, sample);
    const double log_cos = math::log_cosine(sample.aspecular_rad);
    for (std::size_t j = 0; j < flake.lobes.size(); ++j)
      power[j] = weight * math::power_of_cosine(log_cos, flake.lobes[j].exponent);
    for (int c = 0; c < 3; ++c) {
      const int row = c * n + i;
      left[static_cast<std::size_t>(row)] = weight * rest[c];
      for (std::size_t j = 0; j < columns.gray.size(); ++j) m(row, static_cast<int>(j)) = coat * power[columns.gray[j]];
      for (std::size_t j = 0; j < columns.colored.size(); ++j)
        m(row, columns.colored_column(c, j)) = power[columns.colored[j]];
    }
  }
  return math::nnls(m, left);
}

}  // namespace

color::Rgb shown_at(const paint::LobeFit& lobes, const BrdfSample& sample) {
  return kPi * brdf::brdf_by_angles(lobes, sample.aspecular_rad, sample.view_deg, coat_scale(sample));
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

}  // namespace goniochrome::fit
