#include "color/color_bands.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "math/least_squares.h"

namespace goniochrome::color {

namespace {

// How much more the color counts than the shape, whose steps are between 0 and some 0.1 of it: the color is met to
// about 1e-6.
constexpr double kColorCounts = 1e3;

}  // namespace

Bands bands_of_color(const Rgb& wanted, const BandObserver& eye, const Bands& shape) {
  const double size = std::max({std::abs(wanted.x), std::abs(wanted.y), std::abs(wanted.z)});
  if (!(size > 0)) return {};
  math::Matrix rows(kBands - 1 + 3, kBands);
  std::vector<double> right(static_cast<std::size_t>(rows.rows));
  for (int b = 0; b + 1 < kBands; ++b) {
    rows(b, b) = -1, rows(b, b + 1) = 1;
    const auto at = static_cast<std::size_t>(b);
    right[at] = (shape[at + 1] - shape[at]) / size;
  }
  for (int c = 0; c < 3; ++c) {
    for (int b = 0; b < kBands; ++b)
      rows(kBands - 1 + c, b) = kColorCounts * eye.weights()[static_cast<std::size_t>(b)][c];
    right[static_cast<std::size_t>(kBands - 1 + c)] = kColorCounts * wanted[c] / size;
  }
  const math::NonNegativeFit fit = math::nnls(rows, right);
  Bands bands{};
  for (std::size_t b = 0; b < bands.size(); ++b) bands[b] = size * fit.x[b];
  return bands;
}

}  // namespace goniochrome::color
