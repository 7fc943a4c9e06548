// The measurement geometries of multi-angle instruments (ASTM E2194, E2539), their names such as `45as15`, and the
// directions of light and detector that they stand for. goniochrome-paint(7), "CONVENTIONS".
#pragma once

#include <string>
#include <string_view>

#include "base/result.h"
#include "base/vec3.h"

namespace goniochrome::paint {

// `45as15`: light 45 deg from the normal, detector 15 deg from specular, toward the normal. In plane the aspecular
// angle is signed; with an azimuth it is unsigned and azimuth 0 lies on the grazing side.
struct Geometry {
  double incidence_deg = 45;
  double aspecular_deg = 45;
  bool out_of_plane = false;
  double azimuth_deg = 0;  // of the aspecular cone, only where out_of_plane
  bool reversed = false;   // `r`: light and detector trade places
  friend bool operator==(const Geometry&, const Geometry&) = default;
};

// Any of `45as15 r45as-15 15as-45 45as25az90 45asMinus15 15` (a bare number is the aspecular angle at 45 deg).
// Error: the text and what would be right.
Result<Geometry> parse_geometry(std::string_view text);

// The canonical name: `45as15`, `r45as-15`, `45as25az-76`.
std::string geometry_name(const Geometry& geometry);

// The unit directions to the light and to the detector, in the frame x = plane of incidence, z = normal.
struct DirectionPair {
  Vec3 light, view;
};
DirectionPair directions(const Geometry& geometry);

// The unsigned aspecular angle, 0..180.
double aspecular_angle_deg(const Geometry& geometry);

// The angle between the mirror direction of `to_light` and `to_viewer`, in radians, 0..pi. It is right to 4 ulp for any
// vectors but zero; their lengths do not matter.
double aspecular_angle_rad(const Vec3& to_light, const Vec3& to_viewer, const Vec3& normal);

}  // namespace goniochrome::paint
