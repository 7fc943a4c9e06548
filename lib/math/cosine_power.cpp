#include "math/cosine_power.h"

#include <algorithm>
#include <limits>

#include "base/angles.h"
#include "math/elementary.h"

namespace goniochrome::math {

// pow(cos x, E) multiplies the relative error of cos x, half an ulp, by E: 1e-10 at E = 1e6. exp(E log cos x) needs
// log cos x to a few ulp of ITSELF: below 45 deg by log1p(-sin^2)/2, where sin^2 <= 1/2 keeps its digits; above, cos x
// is at most 0.71 and its logarithm is well conditioned. Where the power is not 0 in double precision the exponent is
// at most 745 in size, so that the few ulp become at most 5e-13.
double log_cosine(double angle_rad) {
  const double angle = std::abs(angle_rad);
  if (angle >= kPi / 2) return -std::numeric_limits<double>::infinity();
  const double s = math::sin(angle);
  return s * s <= 0.5 ? 0.5 * math::log1p(-s * s) : math::log(math::cos(angle));
}

double cos_power(double angle_rad, double exponent) {
  return power_of_cosine(log_cosine(angle_rad), exponent);
}

double cos_power_from_versine(double versine, double exponent) {
  if (versine >= 1) return 0;
  if (exponent == 0) return 1;
  return math::exp(exponent * math::log1p(-versine));
}

double cosine_power(double t, double exponent) {
  if (t <= 0) return 0;
  return exponent == 0 ? 1 : exponent == 1 ? t : math::exp(exponent * math::log(std::min(t, 1.0)));
}

}  // namespace goniochrome::math
