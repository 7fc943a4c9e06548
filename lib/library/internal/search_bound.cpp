#include "library/internal/search_bound.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace goniochrome::library {

// CIEDE2000 [Sharma2005] between x and y, with the mean of a pair written with a bar:
//
//   G  = (1 - sqrt(Cb^7 / (Cb^7 + 25^7))) / 2, Cb the mean CIELAB chroma;  a' = (1 + G) a;  C', h' polar in (a', b)
//   X  = dC'/SC, Y = dH'/SH;  dE^2 = (dL/SL)^2 + X^2 + Y^2 + RT X Y
//   SL = 1 + .015 u^2/sqrt(20 + u^2), u = Lb - 50;  SC = 1 + .045 Cb';  SH = 1 + .015 Cb' T
//   T  = 1 - .17 cos(..) + .24 cos(..) + .32 cos(..) - .20 cos(..)
//   RT = -sin(2 theta) RC, theta = 30 deg exp(-((hb' - 275)/25)^2), RC = 2 sqrt(Cb'^7 / (Cb'^7 + 25^7))
//
// Claim. dE^2 >= (dL/SL)^2 + (1 - (sqrt(3)/4) RC) ((1 + G)^2 da^2 + db^2) / SC^2.
//
// 1. dC'^2 + dH'^2 = da'^2 + db^2 = (1 + G)^2 da^2 + db^2. For dH' = 2 sqrt(C1' C2') sin(dh'/2) gives dH'^2 = 2 C1' C2'
//    (1 - cos dh'), so the sum is C1'^2 + C2'^2 - 2 C1' C2' cos dh', the law of cosines in the (a', b) plane; both
//    colors of a pair share one G. If C1' C2' = 0, dH' is 0 and both sides are the square of the other chroma.
// 2. |T - 1| <= .17 + .24 + .32 + .20 = .93, so T <= 1.93 and .015 T < .045: 1 <= SH <= SC.
//    Hence X^2 + Y^2 >= (dC'^2 + dH'^2)/SC^2.
// 3. 0 < theta <= 30 deg, so 0 < sin(2 theta) <= sqrt(3)/2 and |RT| <= (sqrt(3)/2) RC. With |X Y| <= (X^2 + Y^2)/2:
//    X^2 + Y^2 + RT X Y >= (1 - (sqrt(3)/4) RC)(X^2 + Y^2), and the factor is positive since RC < 2.
// No step looks at the mean hue, so its jump at hues 180 deg apart does not matter.
//
// Over a box every factor is replaced by its own worst value, which keeps the bound since none is negative:
// 4. |dL|, |da|, |db| are least at the box's nearest point.
// 5. SL grows with |u| (its slope is .015 u (40 + u^2)/(20 + u^2)^1.5), and |u| is largest at an end of the box.
// 6. G falls with Cb. The chroma of y lies between that of the point of the box nearest to and a point farthest from
// the
//    gray axis, which bounds G on both sides: its least value in (1 + G)^2, its largest in Cb'.
// 7. Cb' grows with G and with the chroma of y; RC and SC grow with Cb'.
double de00_floor(const color::Lab& color, const LabBox& box) {
  const auto gap = [](double value, double low, double high) { return std::max({low - value, value - high, 0.0}); };
  const auto squared = [](double x) { return x * x; };
  const auto ratio7 = [&](double chroma) {  // sqrt(C^7/(C^7 + 25^7))
    const double c7 = squared(squared(chroma) * chroma) * chroma;
    return c7 < 1e280 ? std::sqrt(c7 / (c7 + 6103515625.0)) : 1;
  };
  const auto& [low, high] = box;
  const double u = std::max(std::abs((color.L + low.L) / 2 - 50), std::abs((color.L + high.L) / 2 - 50));
  const double SL = 1 + 0.015 * u * u / std::sqrt(20 + u * u);
  const double dL = gap(color.L, low.L, high.L), da = gap(color.a, low.a, high.a), db = gap(color.b, low.b, high.b);

  const double far_a = std::max(std::abs(low.a), std::abs(high.a));
  const double far_b = std::max(std::abs(low.b), std::abs(high.b));
  const double own = std::sqrt(squared(color.a) + squared(color.b));
  const double nearest = std::sqrt(squared(gap(0, low.a, high.a)) + squared(gap(0, low.b, high.b)));
  const double farthest = std::sqrt(squared(far_a) + squared(far_b));
  const double least_stretch = 1.5 - 0.5 * ratio7((own + farthest) / 2);  // 1 + G
  const double most_stretch = 1.5 - 0.5 * ratio7((own + nearest) / 2);
  const double mean_chroma = (std::sqrt(squared(most_stretch * color.a) + squared(color.b)) +
                              std::sqrt(squared(most_stretch * far_a) + squared(far_b))) /
                             2;
  const double SC = 1 + 0.045 * mean_chroma;
  const double turned = 1 - std::numbers::sqrt3 / 2 * ratio7(mean_chroma);  // RC = 2 ratio7
  return std::sqrt(squared(dL / SL) + turned * (squared(least_stretch * da) + squared(db)) / squared(SC));
}

}  // namespace goniochrome::library
