// The lobe model by angles, for those who know a pair of directions by no more. goniochrome-theory(7), LOBE MODEL.
#pragma once

#include <cmath>

#include "color/color.h"
#include "paint/paint.h"

namespace goniochrome::brdf {

// cos_power() of many exponents at one angle: the logarithm of the cosine, minus infinity from 90 deg on, and its
// power.
double log_cosine(double angle_rad);
inline double power_of_cosine(double log_cosine, double exponent) {
  return std::isinf(log_cosine) ? 0 : std::exp(exponent * log_cosine);
}

// f in 1/sr of a viewer `view_deg` from the normal; `gloss_scale` is what a K_G of 1 counts: 1/cos_i, and under a coat
// times coat_fresnel().
color::Rgb brdf_by_angles(const paint::LobeFit& fit, double aspecular_rad, double view_deg, double gloss_scale);

}  // namespace goniochrome::brdf
