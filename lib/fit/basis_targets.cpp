#include "fit/basis_targets.h"

#include <algorithm>

#include "base/angles.h"
#include "brdf/lobe_model.h"
#include "fit/paint_fit.h"
#include "math/cosine_power.h"
#include "math/least_squares.h"

namespace goniochrome::fit {

Result<BasisTarget> basis_target(const paint::Paint& paint, const BasisTargetOptions& options) {
  GONIO_ASSIGN(const paint::TargetCurve curve, paint::TargetCurve::make(paint, options.target));
  GONIO_ASSIGN(const color::Xyz white, color::white_point(paint::condition_of(paint)));
  const auto& known = curve.known_angles_deg();
  const double first = std::max(known.front(), kGlareAngle_deg), last = std::min(known.back(), 110.0);
  if (last <= first) return input_error("paint \"{}\" has one angle: a basis needs at least two", paint.name);

  BasisTarget target;
  target.name = paint.name;
  for (int i = 0; i < options.angles; ++i) {
    const double angle = first + (last - first) * i / (options.angles - 1);
    const color::Lab lab = curve.at(angle);
    const color::Rgb rgb = color::rgb_from_lab(lab, white);
    target.angles_deg.push_back(angle);
    for (int c = 0; c < 3; ++c) {
      target.value[c].push_back(std::max(rgb[c], 0.0));
      target.weight[c].push_back(options.perceptual_weights ? color::lightness_slope(lab.L) : 1);
    }
  }
  return target;
}

Result<BasisTarget> basis_target(const BrdfTarget& brdf, const BasisTargetOptions& options) {
  constexpr double kStep_deg = 2.5, kLast_deg = 110, kSteepest_deg = 75;
  constexpr auto kBins = static_cast<std::size_t>((kLast_deg - kGlareAngle_deg) / kStep_deg);
  struct Bin {
    double count = 0, angle_deg = 0;
    color::Rgb sum;
  };
  std::vector<Bin> bins(kBins);
  for (const BrdfSample& sample : brdf.samples) {
    const double angle_deg = sample.aspecular_rad * (180 / kPi);
    const double at = (angle_deg - kGlareAngle_deg) / kStep_deg;
    if (at < 0 || at >= static_cast<double>(kBins)) continue;
    if (std::max(sample.light_deg, sample.view_deg) > kSteepest_deg) continue;
    Bin& bin = bins[static_cast<std::size_t>(at)];
    ++bin.count, bin.angle_deg += angle_deg, bin.sum += sample.value;
  }
  GONIO_ASSIGN(const color::Xyz white, color::white_point({"D65", 2}));
  BasisTarget target;
  target.name = brdf.paint.name;
  for (const Bin& bin : bins) {
    if (bin.count == 0) continue;
    const color::Rgb mean = (1 / bin.count) * bin.sum;
    target.angles_deg.push_back(bin.angle_deg / bin.count);
    for (int c = 0; c < 3; ++c) {
      target.value[c].push_back(std::max(mean[c], 0.0));
      target.weight[c].push_back(options.perceptual_weights ? color::lightness_slope(color::lab_from_rgb(mean, white).L)
                                                            : 1);
    }
  }
  if (target.angles_deg.size() < 2)
    return input_error("{}: has directions at less than two aspecular angles: a basis needs more", target.name);
  return target;
}

double basis_de00(const std::vector<double>& exponents, const BasisTarget& target) {
  const int rows = static_cast<int>(target.angles_deg.size()), columns = static_cast<int>(exponents.size()) + 1;
  std::vector<color::Rgb> fitted(static_cast<std::size_t>(rows));
  for (int c = 0; c < 3; ++c) {
    math::Matrix m(rows, columns), weighted(rows, columns);
    std::vector<double> b(static_cast<std::size_t>(rows));
    for (int r = 0; r < rows; ++r) {
      const double w = target.weight[c][r];
      b[r] = w * target.value[c][r];
      for (int j = 0; j < columns; ++j) {
        m(r, j) = j == 0 ? 1 : math::cos_power(target.angles_deg[r] * kPi / 180, exponents[j - 1]);
        weighted(r, j) = w * m(r, j);
      }
    }
    const math::NonNegativeFit fit = math::nnls(weighted, b);
    for (int r = 0; r < rows; ++r)
      for (int j = 0; j < columns; ++j) fitted[r][c] += m(r, j) * fit.x[j];
  }
  const color::Xyz white = *color::white_point({"D65", 2});
  double worst = 0;
  for (int r = 0; r < rows; ++r)
    worst = std::max(
        worst,
        color::delta_e_2000(color::lab_from_rgb({target.value[0][r], target.value[1][r], target.value[2][r]}, white),
                            color::lab_from_rgb(fitted[r], white)));
  return worst;
}

}  // namespace goniochrome::fit
