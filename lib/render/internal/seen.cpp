#include "render/internal/seen.h"

#include <algorithm>

namespace goniochrome::render {

namespace {

color::Lab seen_lab(const color::Rgb& radiance, double white_luminance) {
  static const color::Xyz white = color::xyz_d65_from_rgb({1, 1, 1});
  return color::lab_from_xyz(color::xyz_d65_from_rgb((1 / white_luminance) * radiance), white);
}

}  // namespace

double seen_difference(const color::Rgb& a, const color::Rgb& b, double white_luminance) {
  return color::delta_e_2000(seen_lab(a, white_luminance), seen_lab(b, white_luminance));
}

double percentile_95(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>((values.size() * 95 + 99) / 100 - 1);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace goniochrome::render
