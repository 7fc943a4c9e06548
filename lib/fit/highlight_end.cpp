#include "fit/highlight_end.h"

#include <algorithm>

#include "base/angles.h"
#include "fit/paint_fit.h"
#include "math/cosine_power.h"
#include "math/elementary.h"

namespace goniochrome::fit {

// Below the first known angle a the color goes on as f(t) = f(a) (cos t / cos a)^e, with the e that the curve has
// between a and b. Every sum of non-negative lobes is convex in the logarithm against u = -log cos t (a sum of
// exponentials of linear functions), so it lies on or above this line: the extension is the least highlight that the
// lobes can have, and it leaves no reason for a sharp lobe with an arbitrary weight.
color::Rgb highlight_exponents(const HighlightEnd& end, double steepest) {
  const double cos_a = math::cos(end.a_deg * kDegree), cos_b = math::cos(end.b_deg * kDegree);
  color::Rgb exponents;
  for (int c = 0; c < 3; ++c) {
    if (end.at_a[c] <= std::max(0.0, end.at_b[c]) || cos_b <= 0) continue;
    exponents[c] = end.at_b[c] > 0 ? std::min(steepest, math::log(end.at_a[c] / end.at_b[c]) / math::log(cos_a / cos_b))
                                   : steepest;
  }
  return exponents;
}

color::Rgb highlight_at(const HighlightEnd& end, const color::Rgb& exponents, double t_deg) {
  const double rise = math::cos(t_deg * kDegree) / math::cos(end.a_deg * kDegree);
  color::Rgb value = end.at_a;
  for (int c = 0; c < 3; ++c) value[c] *= math::pow(rise, exponents[c]);
  return value;
}

std::vector<double> seen_exponents(const std::vector<double>& exponents, double first_rad) {
  std::vector<double> seen;
  for (const double e : exponents)
    if (math::cos_power(first_rad, e) >= kSeenPart) seen.push_back(e);
  return seen;
}

double steepest_seen(const std::vector<double>& exponents, double first_rad) {
  const std::vector<double> seen = seen_exponents(exponents, first_rad);
  return seen.empty() ? 0 : std::ranges::max(seen);
}

}  // namespace goniochrome::fit
