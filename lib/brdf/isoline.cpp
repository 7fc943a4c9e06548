#include "brdf/isoline.h"

#include <algorithm>
#include <cmath>

namespace goniochrome {

namespace {

// Both directions refracted into the coat, as half their sum and difference. With p and q the parts of the refracted
// directions a and b along the surface and az, bz those along the normal:
//
//   s = p + q,  d = p - q,  sigma = az + bz,  delta = bz - az = (d.s)/sigma         (|p|^2 + az^2 = |q|^2 + bz^2 = 1)
//   |a+b|^2 = |s|^2 + sigma^2 = H^2 = (2 cos t_inc)^2,     |a-b|^2 = |d|^2 + delta^2 = D^2 = (2 sin t_inc)^2
//   cos t_flake = sigma/H,  sin t_flake = |s|/H
//
// No difference is taken that the input does not hold already.
struct InCoat {
  double pz, qz;          // cosines in air
  double az, bz;          // in the coat
  double s, D, H, sigma;  // lengths
  double along, across;   // p.q, p x q

  InCoat(const Vec3& wi, const Vec3& wo, double index) : pz(wi.z), qz(wo.z) {
    const double contrast = (index - 1) * (index + 1);
    az = std::sqrt(contrast + pz * pz) / index;
    bz = std::sqrt(contrast + qz * qz) / index;
    const double px = wi.x / index, py = wi.y / index, qx = wo.x / index, qy = wo.y / index;
    along = px * qx + py * qy;
    across = px * qy - py * qx;
    const double sx = px + qx, sy = py + qy, dx = px - qx, dy = py - qy;
    sigma = az + bz;
    // Two directions at grazing angles in a coat of index 1 leave sigma = 0, where both cosines are 0 alike.
    const double delta = sigma > 0 ? (dx * sx + dy * sy) / sigma : 0;
    s = std::hypot(sx, sy);
    D = std::hypot(dx, dy, delta);
    H = std::hypot(s, sigma);
  }
};

// The in-plane pair with its sines; that of the nearer is negative across the normal from the farther.
struct Solved {
  double cos_far, sin_far, cos_near, sin_near;
};

double other_leg(double leg) {
  return std::sqrt(std::max((1 - leg) * (1 + leg), 0.0));
}

// kSlide puts the nearer direction at the in-coat angle 2 t_flake - critical.
void slide(const InCoat& in, double index, Solved& pair) {
  const double h2 = in.H * in.H;
  const double sin_2flake = 2 * in.s * in.sigma / h2, cos_2flake = (in.sigma - in.s) * (in.sigma + in.s) / h2;
  pair.sin_near = std::clamp(sin_2flake * std::sqrt((index - 1) * (index + 1)) - cos_2flake, -1.0, 1.0);
  pair.cos_near = other_leg(pair.sin_near);
}

// kSlideMap: the map goes on to the left of its border, x = -beyond = -sqrt(n^2 sin^2 t1 - 1), and lines parallel to
// its gloss line x + height = 1 go down by as much as they go right. Heights are 0 at the normal, 1 on the far horizon,
// -1 on the near one.
void slide_in_map(double beyond, Solved& pair) {
  const double height = pair.sin_near <= 0 ? 1 - pair.cos_near : pair.cos_near - 1;
  const double slid = std::max(height - beyond, -1.0);
  pair.cos_near = 1 - std::abs(slid);
  pair.sin_near = std::copysign(other_leg(pair.cos_near), -slid);
}

// The in-coat angles are t1 = t_flake + t_inc and t2 = t_flake - t_inc. From the lengths above
//
//   cos t1 = (sigma - |s| D/H)/2,    cos t2 = (sigma + |s| D/H)/2,    their sum is az + bz,
//
// and |s| D - |delta| H, multiplied by its conjugate, is |s|^2 |d|^2 - (s.d)^2 = (s x d)^2 = 4 (p x q)^2, so that
//
//   cos t1 = min(az,bz) - e,   cos t2 = max(az,bz) + e,   e = 2 (p x q)^2 / (H (|s| D + |delta| H)).
//
// e is 0 in plane. Refracted out with n^2 az^2 = n^2 - 1 + pz^2, the cosines in air are
//
//   far^2 = pz^2 - n^2 e (2 az - e),   near^2 = qz^2 + n^2 e (2 bz + e)             (pz <= qz, az <= bz)
//
// whose first is negative beyond the critical angle. The sine of the nearer one comes from
// sin t2 = 2 (H^2 p.q + (p x q)^2) / (H (|s| H + sigma D)), that of the farther from sin t1 = (|s| + sigma D/H)/2.
Solved solved(const Vec3& to_light, const Vec3& to_viewer, double index, CriticalAngle treatment) {
  const double n = treatment == CriticalAngle::kIndexOne ? 1 : index;
  const InCoat in(to_light, to_viewer, n);
  const double low = std::min(in.az, in.bz), high = std::max(in.az, in.bz);
  const double low_air = std::min(in.pz, in.qz), high_air = std::max(in.pz, in.qz);
  const double below = in.H * (in.s * in.D + (high - low) * in.H);
  const double e = below > 0 ? 2 * in.across * in.across / below : 0;
  const double far2 = low_air * low_air - n * n * e * (2 * low - e);
  const double near2 = high_air * high_air + n * n * e * (2 * high + e);

  Solved pair = {std::sqrt(std::max(far2, 0.0)), 1, std::min(std::sqrt(near2), 1.0), 0};
  const double legs = in.H * (in.s * in.H + in.sigma * in.D);
  if (legs > 0) {
    if (far2 > 0) pair.sin_far = std::min(0.5 * n * (in.s + in.sigma * in.D / in.H), 1.0);
    pair.sin_near = 2 * n * (in.H * in.H * in.along + in.across * in.across) / legs;
  } else if (in.H > 0) {
    pair.sin_far = 0;  // both along the normal
  } else {
    pair.sin_near = -1;  // both at the horizon, opposite, index 1
  }
  if (far2 >= 0) return pair;
  if (treatment == CriticalAngle::kSlide) slide(in, n, pair);
  if (treatment == CriticalAngle::kSlideMap) slide_in_map(std::sqrt(-far2), pair);
  return pair;
}

}  // namespace

FlakeAngles flake_angles(const Vec3& to_light, const Vec3& to_viewer, double index) {
  const InCoat in(to_light, to_viewer, index);
  return {std::atan2(in.s, in.sigma), std::atan2(in.D, in.H)};
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
  const Solved pair = solved(to_light, to_viewer, index, treatment);
  return {pair.cos_far, pair.cos_near, pair.sin_near > 0};
}

InPlaneAngles equivalent_in_plane_angles(const Vec3& to_light, const Vec3& to_viewer, double index,
                                         CriticalAngle treatment) {
  const Solved pair = solved(to_light, to_viewer, index, treatment);
  const double far_rad = std::atan2(pair.sin_far, pair.cos_far), near_rad = std::atan2(pair.sin_near, pair.cos_near);
  const double steeper = to_viewer.z - to_light.z;
  const bool light_is_far =
      steeper != 0 ? steeper > 0 : std::hypot(to_light.x, to_light.y) >= std::hypot(to_viewer.x, to_viewer.y);
  if (light_is_far) return {far_rad, near_rad};
  return near_rad >= 0 ? InPlaneAngles{near_rad, far_rad} : InPlaneAngles{-near_rad, -far_rad};
}

}  // namespace goniochrome
