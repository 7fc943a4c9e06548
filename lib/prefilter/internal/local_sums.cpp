#include "prefilter/internal/local_sums.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "prefilter/internal/lobe_patch.h"

namespace goniochrome::prefilter {

namespace {

// The share cos^(E+1) r of a lobe lies beyond the angle r. With cos r = exp(-x), 1 - cos r = 2 sin^2 (r/2).
double reach_rad(double exponent, double left_out) {
  const double x = -std::log(left_out) / (exponent + 1);
  return 2 * std::asin(std::sqrt(-std::expm1(-x) / 2));
}

}  // namespace

bool LocalSums::serve(const envmap::Environment& env, const ZonalKernel& kernel, double tolerance) {
  constexpr double kLeastTolerance = 4e-6, kSharp = 30, kMostTexels = 1500;
  return env.layout() == envmap::SphereGrid::Layout::kLatLong && tolerance >= kLeastTolerance &&
         dynamic_cast<const CosineKernel*>(&kernel) && kernel.sharpness() > kSharp &&
         texels_within(env, kernel.exponent()) < kMostTexels;
}

double LocalSums::texels_within(const envmap::Environment& env, double exponent) {
  constexpr double kUsuallyLeftOut = 1e-16;
  const double reach = reach_rad(exponent, kUsuallyLeftOut) + kPi / env.height();
  return reach * reach / 4 * env.width() * env.height();
}

std::vector<Vec3> LocalSums::lobe(const std::vector<Vec3>& directions, const CosineKernel& kernel,
                                  double left_out) const {
  std::vector<Vec3> values = map_.sums(directions, [&](const StripMap::Seat& seat, Strips& strips) {
    weigh(seat, kernel.exponent(), left_out, strips);
  });
  for (Vec3& value : values) value = kernel.scale() * value;
  return values;
}

// The circle of radius r about a direction at the polar angle t spans asin(sin r / sin t) of longitude to either side,
// or all of it where it holds a pole. Texels whose middle is farther away than r and their own radius are left out.
//
// A texel's weight errs by 1e-12 of that of a texel in the middle, and by a hundredth of this on the flank, five widths
// away: of a sun 1e5 times as bright as the mean that is 1e-9 of the mean.
void LocalSums::weigh(const StripMap::Seat& seat, double exponent, double left_out, Strips& strips) const {
  const int width = env_.width(), height = env_.height();
  const double row_rad = kPi / height, column_rad = 2 * kPi / width, reach = reach_rad(exponent, left_out);
  constexpr double kWeightError = 1e-12;
  const double across = std::hypot(seat.d.x, seat.d.z), theta = std::atan2(across, seat.d.y);
  const int top = std::max(0, static_cast<int>((theta - reach) / row_rad));
  const int bottom = std::min(height - 1, static_cast<int>((theta + reach) / row_rad));
  const bool holds_pole = theta <= reach || theta >= kPi - reach;
  const double aside = holds_pole ? kPi : std::asin(std::min(1.0, std::sin(reach) / across)) / column_rad + 1;
  int first = static_cast<int>(std::floor(seat.column - aside)), last = static_cast<int>(seat.column + aside);
  if (holds_pole || last - first >= width) first = 0, last = width - 1;
  thread_local std::vector<float> weights;
  for (int row = top; row <= bottom; ++row) {
    const double least = std::cos(std::min(kPi, reach + env_.radius_rad(0, row, 1, row + 1)));
    // A run of texels ends where the row ends, and goes on at its beginning.
    for (int from = first; from <= last;) {
      const int begin = (from % width + width) % width, count = std::min(last - from + 1, width - begin);
      int near_begin = count, near_end = 0;
      weights.assign(static_cast<std::size_t>(count), 0.0F);
      for (int i = 0; i < count; ++i) {
        if (dot(seat.d, env_.direction(begin + i, row)) < least) continue;
        near_begin = std::min(near_begin, i), near_end = i + 1;
        weights[static_cast<std::size_t>(i)] =
            static_cast<float>(sharp_lobe_over_texel(env_, begin + i, row, seat.d, exponent, kWeightError));
      }
      if (near_begin < near_end)
        strips.add(row, begin + near_begin, &weights[static_cast<std::size_t>(near_begin)],
                   static_cast<std::size_t>(near_end - near_begin));
      from += count;
    }
  }
}

}  // namespace goniochrome::prefilter
