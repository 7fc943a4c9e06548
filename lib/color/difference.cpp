#include <cmath>

#include "base/angles.h"
#include "color/color.h"
#include "math/elementary.h"

namespace goniochrome::color {

namespace {

// Below this chroma the direction of (a,b) is rounding, not hue.
constexpr double kNoHue = 1e-9;

// atan2 turned into [0,360); 0 where there is no hue.
double hue_of(double a, double b) {
  if (math::hypot(a, b) < kNoHue) return 0;
  const double degrees = math::atan2(b, a) * (180 / kPi);  // fits by color differences keep their last digits by it
  if (degrees >= 0) return degrees;
  return degrees + 360 < 360 ? degrees + 360 : 0;
}

// sqrt(C^7/(C^7 + 25^7)), which pulls gray axes together and turns blues.
double chroma_weight(double c) {
  const double c7 = math::pow(c, 7);
  return std::sqrt(c7 / (c7 + 6103515625.0));
}

// The three scaled differences and the rotation term that couples the last two.
struct Terms {
  double l, c, h, rotation;
};

// [Sharma2005] equations 2-22. Swapping the colors only swaps the terms of sums and flips the signs of dL, dC and dH
// together, all of which are exact in floating point, so the result is symmetric to the last bit.
//
// Hues half a turn apart are the one discontinuity. Hue angles carry rounding of about 1e-13 deg, so "at most 180" is
// asked with a margin of 1e-9: opposite hues (pair 14 of the published test data) always take the side of the mean
// that the paper defines, whatever the rounding.
Terms de00_terms(const Lab& x, const Lab& y) {
  const double mean_ab = (math::hypot(x.a, x.b) + math::hypot(y.a, y.b)) / 2;
  const double stretch = 1 + 0.5 * (1 - chroma_weight(mean_ab));
  const double ax = stretch * x.a, ay = stretch * y.a;
  const double cx = math::hypot(ax, x.b), cy = math::hypot(ay, y.b);
  const double hx = hue_of(ax, x.b), hy = hue_of(ay, y.b);
  const bool gray = cx < kNoHue || cy < kNoHue;
  const bool near = std::abs(hy - hx) <= 180 + 1e-9;

  double turn = hy - hx, hue = hx + hy;
  if (gray) {
    turn = 0;
  } else if (near) {
    hue = hue / 2;
  } else {
    turn += turn > 0 ? -360 : 360;
    hue = (hue < 360 ? hue + 360 : hue - 360) / 2;
  }
  const double dL = y.L - x.L, dC = cy - cx, dH = 2 * std::sqrt(cx * cy) * math::sin(turn / 2 * kDegree);
  const double mean_L = (x.L + y.L) / 2, mean_C = (cx + cy) / 2;

  const double T = 1 - 0.17 * math::cos((hue - 30) * kDegree) + 0.24 * math::cos(2 * hue * kDegree) +
                   0.32 * math::cos((3 * hue + 6) * kDegree) - 0.20 * math::cos((4 * hue - 63) * kDegree);
  const double offset = (mean_L - 50) * (mean_L - 50);
  const double sL = 1 + 0.015 * offset / std::sqrt(20 + offset);
  const double sC = 1 + 0.045 * mean_C;
  const double sH = 1 + 0.015 * mean_C * T;
  const double bump = (hue - 275) / 25;
  const double rT = -2 * chroma_weight(mean_C) * math::sin(60 * math::exp(-bump * bump) * kDegree);

  return {dL / sL, dC / sC, dH / sH, rT};
}

}  // namespace

double delta_e_76(const Lab& x, const Lab& y) {
  return math::hypot(x.L - y.L, x.a - y.a, x.b - y.b);
}

double delta_e_2000(const Lab& x, const Lab& y) {
  const auto [l, c, h, rotation] = de00_terms(x, y);
  return std::sqrt(l * l + c * c + h * h + rotation * c * h);
}

// l^2 + c^2 + h^2 + R c h = l^2 + (c + R h/2)^2 + (1 - R^2/4) h^2, and |R| < 2.
Vec3 delta_e_2000_vector(const Lab& x, const Lab& y) {
  const auto [l, c, h, rotation] = de00_terms(x, y);
  return {l, c + 0.5 * rotation * h, std::sqrt(1 - 0.25 * rotation * rotation) * h};
}

double hue_deg(const Lab& lab) {
  return hue_of(lab.a, lab.b);
}

double chroma(const Lab& lab) {
  return math::hypot(lab.a, lab.b);
}

}  // namespace goniochrome::color
