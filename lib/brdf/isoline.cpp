#include "brdf/isoline.h"

#include <algorithm>
#include <cmath>

#include "math/elementary.h"

namespace goniochrome::brdf {

namespace {

// Both directions refracted into the coat, as their sum and difference. With p and q the parts of the refracted
// directions a and b along the surface and az, bz those along the normal:
//
//   s = p + q,  d = p - q,  sigma = az + bz,  delta = bz - az = (d.s)/sigma         (|p|^2 + az^2 = |q|^2 + bz^2 = 1)
//   |a+b|^2 = |s|^2 + sigma^2 = H^2 = (2 cos t_inc)^2,     |a-b|^2 = |d|^2 + delta^2 = D^2 = (2 sin t_inc)^2
//   cos t_flake = sigma/H,  sin t_flake = |s|/H
//
// No difference is taken that the input does not hold already. Lengths are kept as squares: most are never needed.
struct InCoat {
  double n;
  double low_air, high_air;  // cosines in air
  double low, high, sigma;   // in the coat
  double delta;              // high - low
  double s2, D2, H2;
  double along, across;  // p.q, p x q

  InCoat(const Vec3& wi, const Vec3& wo, double index) : n(index) {
    low_air = std::min(wi.z, wo.z), high_air = std::max(wi.z, wo.z);
    const double contrast = (n - 1) * (n + 1), inverse = 1 / n;
    low = std::sqrt(contrast + low_air * low_air) * inverse;
    high = std::sqrt(contrast + high_air * high_air) * inverse;
    const double px = wi.x * inverse, py = wi.y * inverse, qx = wo.x * inverse, qy = wo.y * inverse;
    along = px * qx + py * qy;
    across = px * qy - py * qx;
    const double sx = px + qx, sy = py + qy, dx = px - qx, dy = py - qy;
    sigma = low + high;
    // Two directions at grazing angles in a coat of index 1 leave sigma = 0, where both cosines are 0 alike.
    delta = sigma > 0 ? std::abs(dx * sx + dy * sy) / sigma : 0;
    s2 = sx * sx + sy * sy;
    D2 = dx * dx + dy * dy + delta * delta;
    H2 = s2 + sigma * sigma;
  }
};

double other_leg(double leg) {
  return std::sqrt(std::max((1 - leg) * (1 + leg), 0.0));
}

// kSlide puts the nearer direction at the in-coat angle 2 t_flake - critical.
void slide(const InCoat& in, InPlane& pair) {
  const double sin_2flake = 2 * std::sqrt(in.s2) * in.sigma / in.H2, cos_2flake = (in.sigma * in.sigma - in.s2) / in.H2;
  const double sine = sin_2flake * std::sqrt((in.n - 1) * (in.n + 1)) - cos_2flake;
  pair.cos_near = other_leg(sine);
  pair.same_side = sine > 0;
}

// kSlideMap: the map goes on to the left of its border, x = -beyond = -sqrt(n^2 sin^2 t1 - 1), and lines parallel to
// its gloss line x + height = 1 go down by as much as they go right. Heights are 0 at the normal, 1 on the far horizon,
// -1 on the near one.
void slide_in_map(double beyond, InPlane& pair) {
  const double height = pair.same_side ? pair.cos_near - 1 : 1 - pair.cos_near;
  const double slid = std::max(height - beyond, -1.0);
  pair.cos_near = 1 - std::abs(slid);
  pair.same_side = slid < 0;
}

// The in-coat angles are t1 = t_flake + t_inc and t2 = t_flake - t_inc. From the lengths above
//
//   cos t1 = (sigma - |s| D/H)/2,    cos t2 = (sigma + |s| D/H)/2,    their sum is az + bz,
//
// and |s| D - |delta| H, multiplied by its conjugate, is |s|^2 |d|^2 - (s.d)^2 = (s x d)^2 = 4 (p x q)^2, so that
//
//   cos t1 = min(az,bz) - e,   cos t2 = max(az,bz) + e,   e = 2 (p x q)^2 / (H |s| D + |delta| H^2).
//
// e is 0 in plane. Refracted out with n^2 az^2 = n^2 - 1 + pz^2, the cosines in air are
//
//   far^2 = pz^2 - n^2 e (2 az - e),   near^2 = qz^2 + n^2 e (2 bz + e)             (pz <= qz, az <= bz)
//
// whose first is negative beyond the critical angle. The nearer one is on the side of the farther where
// sin t2 = 2 (H^2 p.q + (p x q)^2) / (H (|s| H + sigma D)) is positive. Returns far^2.
double solve(const InCoat& in, CriticalAngle treatment, InPlane& pair) {
  const double below = std::sqrt(in.H2 * in.s2 * in.D2) + in.delta * in.H2;
  const double e = below > 0 ? 2 * in.across * in.across / below : 0, n2e = in.n * in.n * e;
  const double far2 = in.low_air * in.low_air - n2e * (2 * in.low - e);
  const double near2 = in.high_air * in.high_air + n2e * (2 * in.high + e);
  pair = {std::sqrt(std::max(far2, 0.0)), std::sqrt(std::min(near2, 1.0)),
          in.H2 * in.along + in.across * in.across > 0};
  if (far2 >= 0) return far2;
  if (treatment == CriticalAngle::kSlide) slide(in, pair);
  if (treatment == CriticalAngle::kSlideMap) slide_in_map(std::sqrt(-far2), pair);
  return far2;
}

double coat_index(double index, CriticalAngle treatment) {
  return treatment == CriticalAngle::kIndexOne ? 1 : index;
}

// Where cosines are near 1 the angles come from the sines: sin t1 = (|s| + sigma D/H)/2, and sin t2 as above.
struct Sines {
  double far, near;  // of a pair that was not moved; the nearer negative across the normal
};
Sines sines(const InCoat& in, const InPlane& pair) {
  const double s = std::sqrt(in.s2), D = std::sqrt(in.D2), H = std::sqrt(in.H2), legs = H * (s * H + in.sigma * D);
  if (legs > 0)
    return {std::min(0.5 * in.n * (s + in.sigma * D / H), 1.0),
            2 * in.n * (in.H2 * in.along + in.across * in.across) / legs};
  // Both along the normal; or both at the horizon, opposite, with index 1.
  return H > 0 ? Sines{0, 0} : Sines{1, pair.same_side ? 1.0 : -1.0};
}

}  // namespace

FlakeAngles flake_angles(const Vec3& to_light, const Vec3& to_viewer, double index) {
  const InCoat in(to_light, to_viewer, index);
  return {math::atan2(std::sqrt(in.s2), in.sigma), math::atan2(std::sqrt(in.D2), std::sqrt(in.H2))};
}

std::optional<CriticalAngle> critical_angle_of(std::string_view name) {
  for (const auto t :
       {CriticalAngle::kClip, CriticalAngle::kSlide, CriticalAngle::kSlideMap, CriticalAngle::kIndexOne}) {
    if (name == critical_angle_name(t)) return t;
  }
  return std::nullopt;
}

const char* critical_angle_name(CriticalAngle treatment) {
  switch (treatment) {
    case CriticalAngle::kClip:
      return "clip";
    case CriticalAngle::kSlide:
      return "slide";
    case CriticalAngle::kSlideMap:
      return "slide-map";
    case CriticalAngle::kIndexOne:
      return "index";
  }
  return "";
}

InPlane equivalent_in_plane(const Vec3& to_light, const Vec3& to_viewer, double index, CriticalAngle treatment) {
  InPlane pair;
  solve(InCoat(to_light, to_viewer, coat_index(index, treatment)), treatment, pair);
  return pair;
}

InPlaneAngles equivalent_in_plane_angles(const Vec3& to_light, const Vec3& to_viewer, double index,
                                         CriticalAngle treatment) {
  const InCoat in(to_light, to_viewer, coat_index(index, treatment));
  InPlane pair;
  const bool beyond = solve(in, treatment, pair) < 0;
  const bool moved = beyond && (treatment == CriticalAngle::kSlide || treatment == CriticalAngle::kSlideMap);
  Sines sine = sines(in, pair);
  if (beyond) sine.far = 1;
  if (moved) sine.near = (pair.same_side ? 1 : -1) * other_leg(pair.cos_near);
  const double far_rad = math::atan2(sine.far, pair.cos_far), near_rad = math::atan2(sine.near, pair.cos_near);
  const double steeper = to_viewer.z - to_light.z;
  const bool light_is_far =
      steeper != 0 ? steeper > 0 : math::hypot(to_light.x, to_light.y) >= math::hypot(to_viewer.x, to_viewer.y);
  if (light_is_far) return {far_rad, near_rad};
  return near_rad >= 0 ? InPlaneAngles{near_rad, far_rad} : InPlaneAngles{-near_rad, -far_rad};
}

}  // namespace goniochrome::brdf
