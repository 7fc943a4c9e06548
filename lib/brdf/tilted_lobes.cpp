#include "brdf/tilted_lobes.h"

#include <algorithm>

#include "base/angles.h"
#include "math/elementary.h"

namespace goniochrome::brdf {

namespace {

// The share of its full tilt that an axis has at a view.
double taper(double view_deg) {
  return std::min(1.0, math::sin(view_deg * kDegree) / math::sin(kFullTilt_deg * kDegree));
}

// In-plane angle from the normal, and the angle out of the plane, in radians.
struct AxisAngles {
  double in, out;
};
AxisAngles axis_angles(const paint::TiltedLobe& lobe, double view_deg) {
  const double share = taper(view_deg);
  return {(view_deg + share * lobe.tilt_deg) * kDegree, share * lobe.out_deg * kDegree};
}

}  // namespace

Vec3 tilted_axis(const paint::TiltedLobe& lobe, double view_deg) {
  const auto [in, out] = axis_angles(lobe, view_deg);
  return {math::sin(in) * math::cos(out), math::sin(out), math::cos(in) * math::cos(out)};
}

// With t the viewer's angle, r = sin t x + cos t n and n x o = -sin t y. Hence x = (r - cos t n)/sin t, and the sign of
// c does not matter. The axis has x and y in proportion to sin t near the normal, so that both quotients are finite; at
// the normal itself any of them serves, since r = n and n x o = 0, and what remains is a + s = 1.
AxisSum axis_sum(const paint::TiltedLobe& lobe, double view_deg) {
  constexpr double kLeast_deg = 1e-4;
  const double view = std::max(view_deg, kLeast_deg), sine = math::sin(view * kDegree);
  const Vec3 axis = tilted_axis(lobe, view);
  const double a = axis.x / sine;
  return {a, axis.z - a * math::cos(view * kDegree), axis.y / sine};
}

paint::TiltedView at_view(const paint::TiltedLobes& set, double view_deg) {
  const auto above = std::ranges::upper_bound(set.views, view_deg, {}, &paint::TiltedView::view_deg);
  if (above == set.views.begin()) return set.views.front();
  if (above == set.views.end()) return set.views.back();
  const paint::TiltedView &low = above[-1], &high = *above;
  const double share = (view_deg - low.view_deg) / (high.view_deg - low.view_deg);
  paint::TiltedView view{view_deg, (1 - share) * low.diffuse + share * high.diffuse, {}};
  for (std::size_t k = 0; k < low.weights.size(); ++k)
    view.weights.push_back((1 - share) * low.weights[k] + share * high.weights[k]);
  return view;
}

color::Rgb reflected_part(const paint::TiltedLobes& set, const Vec3& to_light, double view_deg) {
  const paint::TiltedView view = at_view(set, view_deg);
  color::Rgb sum = std::max(0.0, to_light.z) * view.diffuse;
  for (std::size_t k = 0; k < set.lobes.size(); ++k) {
    const paint::TiltedLobe& lobe = set.lobes[k];
    const Vec3 axis = tilted_axis(lobe, view_deg);
    double power = 0;
    for (const double side : {1.0, -1.0}) {
      const double cosine = dot({axis.x, side * axis.y, axis.z}, to_light);
      if (cosine > 0) power += 0.5 * math::pow(cosine, lobe.exponent);
    }
    sum += (lobe.exponent + 1) / (2 * kPi) * power * view.weights[k];
  }
  return sum;
}

}  // namespace goniochrome::brdf
