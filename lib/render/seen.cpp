#include "render/seen.h"

#include <algorithm>

namespace goniochrome {

namespace {

Lab seen_lab(const Rgb& radiance, double white_luminance) {
  static const Xyz white = xyz_d65_from_rgb({1, 1, 1});
  return lab_from_xyz(xyz_d65_from_rgb((1 / white_luminance) * radiance), white);
}

}  // namespace

double seen_difference(const Rgb& a, const Rgb& b, double white_luminance) {
  return delta_e_2000(seen_lab(a, white_luminance), seen_lab(b, white_luminance));
}

double percentile_95(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>((values.size() * 95 + 99) / 100 - 1);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace goniochrome
