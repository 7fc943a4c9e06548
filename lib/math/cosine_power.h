// Every lobe is a power of a cosine. These powers are exact for exponents up to 1e6 and for angles down to 1e-8 rad,
// and 0 from 90 degrees on. goniochrome-lobes(7), "LOBE MODEL".
#pragma once

#include <cmath>

#include "math/elementary.h"

namespace goniochrome::math {

// The logarithm of cos(angle), to a few ulp of itself; minus infinity from 90 degrees on.
double log_cosine(double angle_rad);

// cos^E from that logarithm, for callers that raise one cosine to many exponents.
inline double power_of_cosine(double log_cosine, double exponent) {
  return std::isinf(log_cosine) ? 0 : math::exp(exponent * log_cosine);
}

// cos(angle)^exponent for 0 <= angle_rad <= pi/2 (0 beyond), exponent 0..1e6, relative error <= 1e-12.
double cos_power(double angle_rad, double exponent);

// The power from the versine |r - d|^2 / 2 = 1 - cos, which two nearly parallel unit vectors give without cancellation.
double cos_power_from_versine(double versine, double exponent);

// max(0, t)^E for t = cos(angle) in [-1,1]; E = 0 is 1 above the horizon and 0 below. Its relative error is E times
// that of t.
double cosine_power(double t, double exponent);

}  // namespace goniochrome::math
