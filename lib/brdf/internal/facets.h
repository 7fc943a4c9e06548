// The slopes of the facets of a rough surface: how often they occur, and how much of each other they hide.
// goniochrome-coats(7), "SATIN".
#pragma once

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/vec3.h"
#include "brdf/rough_coat.h"
#include "math/elementary.h"

namespace goniochrome::brdf {

// One scale of facets, whose normals are h with tan of their angle t as slope.
struct Facets {
  double slope = 0;
  Slopes slopes = Slopes::kGgx;

  // D(h), 1/sr: a^2/(pi cos^4 t (a^2 + tan^2 t)^2) of GGX, exp(-tan^2 t/a^2)/(pi a^2 cos^4 t) of Gaussian slopes. The
  // sine keeps its digits where the half vector is near the normal. `half` is above the horizon.
  double density(const Vec3& half) const {
    const double a2 = slope * slope, z2 = half.z * half.z, flat = half.x * half.x + half.y * half.y;
    if (slopes == Slopes::kGaussian) return math::exp(-flat / (a2 * z2)) / (kPi * a2 * z2 * z2);
    const double spread = a2 * z2 + flat;
    return a2 / (kPi * spread * spread);
  }

  // L, of which the part 1/(1 + L) of the facets that face a direction is seen from there [Heitz2014]. For Gaussian
  // slopes it is (erf(v) - 1)/2 + exp(-v^2)/(2 v sqrt(pi)) with v = 1/(a tan), to 1e-7.
  double masking(double cosine) const {
    const double tangent2 = std::max(0.0, (1 - cosine * cosine) / (cosine * cosine)),
                 spread2 = slope * slope * tangent2;
    if (slopes == Slopes::kGgx) return 0.5 * (std::sqrt(1 + spread2) - 1);
    constexpr double kUnhidden = 1e-2;  // exp(-1/kUnhidden) is nothing
    if (spread2 < kUnhidden) return 0;
    const double v = 1 / std::sqrt(spread2), tail = math::exp(-v * v);
    return std::max(0.0, tail / (2 * v * std::sqrt(kPi)) - 0.5 * tail * erfc_over_gaussian(v));
  }

 private:
  // erfc(v) exp(v^2) for v >= 0, to 1.5e-7 [AbramowitzStegun] 7.1.26.
  static double erfc_over_gaussian(double v) {
    const double t = 1 / (1 + 0.3275911 * v);
    return t * (0.254829592 + t * (-0.284496736 + t * (1.421413741 + t * (-1.453152027 + t * 1.061405429))));
  }
};

}  // namespace goniochrome::brdf
