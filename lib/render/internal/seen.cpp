#include "render/internal/seen.h"

#include "math/statistics.h"

namespace goniochrome::render {

double seen_difference(const color::Rgb& a, const color::Rgb& b, double white_luminance) {
  static const color::Xyz white = color::xyz_d65_from_rgb({1, 1, 1});
  const double scale = white_luminance > 0 ? 1 / white_luminance : 1;
  const auto lab = [&](const color::Rgb& radiance) {
    return color::lab_from_xyz(color::xyz_d65_from_rgb(scale * radiance), white);
  };
  return color::delta_e_2000(lab(a), lab(b));
}

double percentile_95(std::vector<double> values) {
  return values.empty() ? 0 : math::percentile_95(std::move(values));
}

}  // namespace goniochrome::render
