#include "render/path/spherical_triangle.h"

#include <algorithm>
#include <cmath>

namespace goniochrome::render {

namespace {

// The unit vector across `axis`, a unit vector, on the side of `toward`; 0 where there is none.
Vec3 across(const Vec3& axis, const Vec3& toward) {
  const Vec3 rest = toward - dot(axis, toward) * axis;
  const double size = length(rest);
  return size > 0 ? (1 / size) * rest : Vec3{};
}

}  // namespace

// [VanOosterom1983]: tan(extent/2) = |a.(b x c)| / (1 + a.b + b.c + c.a). The angle at a is that between a x b and
// a x c, whose cross product is a times a.(b x c).
SphericalTriangle::SphericalTriangle(const rays::Float3& from, const std::array<rays::Float3, 3>& corner)
    : a_(normalized(rays::vec3(corner[0] - from))),
      b_(normalized(rays::vec3(corner[1] - from))),
      c_(normalized(rays::vec3(corner[2] - from))) {
  const Vec3 ab = cross(a_, b_), ac = cross(a_, c_);
  const double volume = std::abs(dot(ab, c_));
  cos_ab_ = dot(a_, b_);
  extent_sr_ = 2 * std::atan2(volume, 1 + cos_ab_ + dot(b_, c_) + dot(c_, a_));
  if (!(extent_sr_ > 0)) {  // a corner is the point itself
    extent_sr_ = 0;
    return;
  }
  angle_ = std::atan2(volume, dot(ab, ac));
  cos_angle_ = std::cos(angle_), sin_angle_ = std::sin(angle_);
}

// [Arvo1995]: c' on the arc from a to c is such that a b c' has the part u of the extent; the direction is on the arc
// from b to c', where it is even in the cosine from b.
Vec3 SphericalTriangle::direction(double u, double v) const {
  const double part = u * extent_sr_ - angle_, s = std::sin(part), t = std::cos(part);
  const double p = t - cos_angle_, q = s + sin_angle_ * cos_ab_, below = (q * s + p * t) * sin_angle_;
  const double cos_b = below != 0 ? std::clamp(((q * t - p * s) * cos_angle_ - q) / below, -1.0, 1.0) : 1;
  const Vec3 c = cos_b * a_ + std::sqrt(1 - cos_b * cos_b) * across(a_, c_);
  const double z = 1 - v * (1 - dot(c, b_));
  return z * b_ + std::sqrt(std::max(0.0, 1 - z * z)) * across(b_, c);
}

}  // namespace goniochrome::render
