#include "color/print_gamut.h"

#include <algorithm>
#include <cmath>

namespace goniochrome::color {

double PrintGamut::most(double lightness, double hue_deg) const {
  if (!(lightness >= darkest && lightness <= lightest)) return 0;
  const double row = (kLightnesses - 1) * (lightness - darkest) / (lightest - darkest),
               column = kHues * (hue_deg / 360 - std::floor(hue_deg / 360));
  const int y = std::min(static_cast<int>(row), kLightnesses - 2), x = static_cast<int>(column);
  const auto at = [&](int i, int j) { return chroma[static_cast<std::size_t>(i * kHues + j % kHues)]; };
  return std::lerp(std::lerp(at(y, x), at(y, x + 1), column - x), std::lerp(at(y + 1, x), at(y + 1, x + 1), column - x),
                   row - y);
}

Lab PrintGamut::nearest(const Lab& lab) const {
  const double lightness = std::clamp(lab.L, darkest, lightest), of = color::chroma(lab);
  const double share = of > 0 ? std::min(1.0, most(lightness, hue_deg(lab)) / of) : 1;
  return {lightness, share * lab.a, share * lab.b};
}

}  // namespace goniochrome::color
