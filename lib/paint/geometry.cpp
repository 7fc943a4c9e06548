#include "paint/geometry.h"

#include <array>
#include <cmath>
#include <optional>

#include "base/angles.h"
#include "base/text.h"
#include "math/elementary.h"
#include "math/twice.h"

namespace goniochrome::paint {

namespace {

// Takes `prefix` off the front of `text`, if it stands there.
bool take(std::string_view& text, std::string_view prefix) {
  if (!text.starts_with(prefix)) return false;
  text.remove_prefix(prefix.size());
  return true;
}

// A number that may say "minus" for its sign.
std::optional<double> signed_number(std::string_view text) {
  if (!take(text, "minus")) return parse_number(text);
  const auto value = parse_number(text);
  if (!value || *value < 0) return std::nullopt;
  return -*value;
}

// `45as25az90` in lower case, without the domain checks.
std::optional<Geometry> syntax(std::string_view text) {
  Geometry geometry;
  geometry.reversed = take(text, "r");
  const auto as = text.find("as");
  if (as == std::string_view::npos) {
    const auto aspecular = signed_number(text);
    if (!aspecular || geometry.reversed) return std::nullopt;
    geometry.aspecular_deg = *aspecular;
    return geometry;
  }
  const auto incidence = parse_number(text.substr(0, as));
  std::string_view rest = text.substr(as + 2);
  const auto az = rest.find("az");
  const auto aspecular = signed_number(rest.substr(0, az));
  if (!incidence || !aspecular) return std::nullopt;
  geometry.incidence_deg = *incidence;
  geometry.aspecular_deg = *aspecular;
  if (az == std::string_view::npos) return geometry;
  const auto azimuth = signed_number(rest.substr(az + 2));
  if (!azimuth) return std::nullopt;
  geometry.out_of_plane = true;
  const double turned = std::remainder(*azimuth, 360.0);
  geometry.azimuth_deg = turned == -180 ? 180 : turned;
  return geometry;
}

using math::product_of;
using math::Twice;

Twice dot_of(const Vec3& a, const Vec3& b) {
  return product_of(a.x, b.x) + product_of(a.y, b.y) + product_of(a.z, b.z);
}

}  // namespace

Result<Geometry> parse_geometry(std::string_view text) {
  const auto geometry = syntax(lower(trimmed(text)));
  if (!geometry)
    return input_error("geometry \"{}\" is not understood: write it like 45as15, 45as-15, r45as15, 45as25az90 or 15",
                       shown(text));
  if (geometry->incidence_deg < 0 || geometry->incidence_deg >= 90)
    return input_error("geometry \"{}\": the light is at {} deg: give 0 to below 90 deg from the normal", shown(text),
                       shortest(geometry->incidence_deg));
  if (geometry->out_of_plane && geometry->aspecular_deg < 0)
    return input_error("geometry \"{}\": with an azimuth the aspecular angle has no sign: turn the azimuth by 180 deg",
                       shown(text));
  // A detector in the surface, but for rounding, sees nothing either.
  const double height = geometry->reversed ? directions(*geometry).light.z : directions(*geometry).view.z;
  if (std::abs(geometry->aspecular_deg) > 180 || height < 1e-12)
    return input_error("geometry \"{}\" puts the detector below the surface: give a smaller aspecular angle",
                       shown(text));
  return *geometry;
}

std::string geometry_name(const Geometry& geometry) {
  std::string name = geometry.reversed ? "r" : "";
  name += shortest(geometry.incidence_deg) + "as" + shortest(geometry.aspecular_deg);
  if (geometry.out_of_plane) name += "az" + shortest(geometry.azimuth_deg);
  return name;
}

// With s the specular direction and g the way from it down to the grazing side, both unit and orthogonal. In plane the
// angle is positive toward the normal, against g; out of plane azimuth 0 is along g.
DirectionPair directions(const Geometry& geometry) {
  const double t = geometry.incidence_deg * kDegree, as = geometry.aspecular_deg * kDegree;
  const double az = geometry.azimuth_deg * kDegree;
  const Vec3 s{math::sin(t), 0, math::cos(t)}, g{math::cos(t), 0, -math::sin(t)}, y{0, 1, 0};
  const Vec3 away = geometry.out_of_plane ? math::cos(az) * g + math::sin(az) * y : -g;
  DirectionPair pair{{-math::sin(t), 0, math::cos(t)}, math::cos(as) * s + math::sin(as) * away};
  if (geometry.reversed) std::swap(pair.light, pair.view);
  return pair;
}

double aspecular_angle_deg(const Geometry& geometry) {
  return std::abs(geometry.aspecular_deg);
}

// With m = 2 (n.l) n - (n.n) l, the mirror direction times |l| |n|^2, the angle is atan2(|m x v|, m.v), whatever the
// lengths. Near 0 and 180 deg the cross product cancels: in double alone it would keep an absolute error of 1e-16, so m
// and both products are carried to twice the digits. Roundings that are left: two in the products, two in the norm, and
// the arc tangent's own; the first four enter multiplied by sin(2 theta)/(2 theta) <= 1.
double aspecular_angle_rad(const Vec3& to_light, const Vec3& to_viewer, const Vec3& normal) {
  const Twice nl = dot_of(normal, to_light), nn = dot_of(normal, normal);
  std::array<Twice, 3> m;
  for (int i = 0; i < 3; ++i) m[i] = nl * (2 * normal[i]) + -(nn * to_light[i]);
  const Vec3& v = to_viewer;
  const auto cross_part = [&](int i, int j) { return (m[i] * v[j] + -(m[j] * v[i])).high; };
  const double along = (m[0] * v.x + m[1] * v.y + m[2] * v.z).high;
  return math::atan2(math::hypot(cross_part(1, 2), cross_part(2, 0), cross_part(0, 1)), along);
}

}  // namespace goniochrome::paint
