#include "materials/internal/widened_mirror.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"

namespace goniochrome::materials {

double mirror_peak(double half_rad) {
  const double t = std::tan(half_rad) / kMirrorSlope, c = std::cos(half_rad);
  return half_rad < 0.2 ? std::exp(-t * t) / (kPi * kMirrorSlope * kMirrorSlope * c * c * c * c) : 0;
}

double mirror_area(double cosine) {
  const double sine = std::sqrt(1 - cosine * cosine), a = cosine / (kMirrorSlope * std::max(sine, 1e-9));
  if (a > 6) return cosine;
  return cosine * (1 + std::erf(a)) / 2 + kMirrorSlope * sine * std::exp(-a * a) / (2 * std::sqrt(kPi));
}

}  // namespace goniochrome::materials
