#include "render/textures/projection.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"

namespace goniochrome::render {

TextureAxes texture_axes(const Vec3& axis, double turn_rad) {
  const Vec3 reference = std::abs(axis.y) < 0.9 ? Vec3{0, 1, 0} : Vec3{0, 0, axis.y > 0 ? -1.0 : 1.0};
  const Vec3 up = normalized(reference - dot(reference, axis) * axis), across = cross(up, axis);
  const double c = std::cos(turn_rad), s = std::sin(turn_rad);
  return {c * across + s * up, c * up - s * across};
}

namespace {

TexturePlace place_of(double u, double v, const Vec3& tangent) {
  return {static_cast<float>(u), static_cast<float>(v), floats(tangent)};
}

// Seen from the other side, u grows the other way, so that lettering can be read from both.
TexturePlace along(const TextureLaying& laying, const Vec3& axis, const Vec3& from_center, double side) {
  const auto [across, up] = texture_axes(axis, laying.turn_rad);
  const Vec3 tangent = side * across;
  return place_of(0.5 + dot(from_center, tangent) / laying.width,
                  0.5 + dot(from_center, up) / (laying.width * laying.aspect), tangent);
}

// The coordinate axis that is nearest to the normal, with its sign.
Vec3 nearest_axis(const Vec3& normal) {
  const double x = std::abs(normal.x), y = std::abs(normal.y), z = std::abs(normal.z);
  if (x >= y && x >= z) return {std::copysign(1.0, normal.x), 0, 0};
  if (y >= z) return {0, std::copysign(1.0, normal.y), 0};
  return {0, 0, std::copysign(1.0, normal.z)};
}

// The middle of the texture lies in front, toward +Z or, for an axis near to it, toward +Y.
TexturePlace around(const TextureLaying& laying, const Vec3& from_center) {
  const Vec3& axis = laying.axis;
  const Vec3 reference = std::abs(axis.z) < 0.9 ? Vec3{0, 0, 1} : Vec3{0, 1, 0};
  const Vec3 front = normalized(reference - dot(reference, axis) * axis), side = cross(axis, front);
  const double longitude = std::atan2(dot(from_center, side), dot(from_center, front)), along = dot(from_center, axis);
  const Vec3 level = from_center - along * axis;
  const double distance = length(level), repeat = laying.around,
               u = 0.5 + (longitude - laying.turn_rad) * repeat / (2 * kPi);
  const Vec3 tangent = distance > 0 ? (1 / distance) * cross(axis, level) : side;
  if (laying.projection == Projection::kSphere)
    return place_of(u, 0.5 + std::atan2(along, distance) * repeat / kPi, tangent);
  return place_of(u, 0.5 + along * repeat / (2 * kPi * laying.radius * laying.aspect), tangent);
}

TexturePlace decal(const TextureLaying& laying, const Vec3& from_center, const Vec3& normal) {
  TexturePlace place = along(laying, laying.axis, from_center, 1);
  const bool behind = dot(normal, laying.axis) <= 0;
  if (laying.ends && (behind || place.u < 0 || place.u > 1 || place.v < 0 || place.v > 1)) place.share = 0;
  if (behind) place.u = place.v = 0;
  const auto edge_u = static_cast<float>(laying.half_texel_u), edge_v = static_cast<float>(laying.half_texel_v);
  place.u = std::clamp(place.u, edge_u, 1 - edge_u), place.v = std::clamp(place.v, edge_v, 1 - edge_v);
  return place;
}

// Along its coordinate axis, from the side on which the surface is seen.
TexturePlace facet(const TextureLaying& laying, const Vec3& from_center, const Vec3& normal) {
  Vec3 axis;
  axis[laying.facet] = std::copysign(1.0, normal[laying.facet]);
  TexturePlace place = along(laying, axis, from_center, 1);
  place.share = static_cast<float>(facet_shares(normal)[laying.facet]);
  return place;
}

}  // namespace

Vec3 facet_shares(const Vec3& normal) {
  Vec3 shares;
  double sum = 0;
  for (int c = 0; c < 3; ++c) shares[c] = std::pow(normal[c], 4), sum += shares[c];
  return sum > 0 ? (1 / sum) * shares : Vec3{0, 1, 0};
}

TexturePlace projected(const TextureLaying& laying, const Vec3& position, const Vec3& normal) {
  const Vec3 from_center = position - laying.center;
  switch (laying.projection) {
    case Projection::kBox:
      return along(laying, nearest_axis(normal), from_center, 1);
    case Projection::kCylinder:
    case Projection::kSphere:
      return around(laying, from_center);
    case Projection::kDecal:
      return decal(laying, from_center, normal);
    case Projection::kFacet:
      return facet(laying, from_center, normal);
    default:
      return along(laying, laying.axis, from_center, dot(normal, laying.axis) < 0 ? -1 : 1);
  }
}

}  // namespace goniochrome::render
