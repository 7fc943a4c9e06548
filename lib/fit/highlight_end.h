// How the color of flakes goes on from the reading that is nearest to specular toward specular.
// goniochrome-fitting(7), "FITTING".
#pragma once

#include <vector>

#include "color/color.h"

namespace goniochrome::fit {

// Reflectance factors of the base at the reading a that is nearest to specular, and at b > a.
struct HighlightEnd {
  double a_deg = 0, b_deg = 0;
  color::Rgb at_a, at_b;
};

// The exponent of each channel below a; no exponent is above `steepest`.
color::Rgb highlight_exponents(const HighlightEnd& end, double steepest);

// The reflectance factor of the base at t (deg) from 0 to a: f(a) (cos t / cos a)^e.
color::Rgb highlight_at(const HighlightEnd& end, const color::Rgb& exponents, double t_deg);

// The exponents whose lobes are seen from that angle on.
std::vector<double> seen_exponents(const std::vector<double>& exponents, double first_rad);

// The sharpest of them; 0 where there is none.
double steepest_seen(const std::vector<double>& exponents, double first_rad);

}  // namespace goniochrome::fit
