// Isochromatic lines of flake paints are the pairs of directions that see the same flakes at the same angle. With a and
// b the two directions, refracted into the coat, and n its normal, they are all pairs of the same
//
//   t_flake = angle(a + b, n)   and   t_incidence = angle(a, a + b)
//
// One pair on each line lies in one plane with the normal and stands for all of them.
// goniochrome-interference(7), "ISOCHROMATIC LINES"; [Kirchner]
#pragma once

#include <optional>
#include <string_view>

#include "base/vec3.h"

namespace goniochrome::brdf {

// The flakes that mirror one direction of a pair into the other, seen inside the coat. Radians.
struct FlakeAngles {
  double flake_rad = 0;      // between the flake's normal and the coat's, 0..critical angle
  double incidence_rad = 0;  // between the light and the flake's normal, 0..critical angle
};

// For unit directions above the surface (z >= 0, normal = z) and a coat of index >= 1. Absolute error 4e-16.
FlakeAngles flake_angles(const Vec3& to_light, const Vec3& to_viewer, double index);

// Treatments where the steeper in-coat angle, flake + incidence, is beyond the critical angle, so that no light comes
// in or out there: 30 % of cosine-weighted pairs at index 1.5.
enum class CriticalAngle {
  kClip,      // the steeper direction lies at 90 deg, the other stays
  kSlide,     // the steeper lies at 90 deg, the flake angle (half the in-coat aspecular angle) stays
  kSlideMap,  // as kSlide, along straight lines of the color map parallel to its gloss line
  kIndexOne,  // no refraction at all; what is still below the horizon is clipped
};

// "clip", "slide", "slide-map", "index", or nothing.
std::optional<CriticalAngle> critical_angle_of(std::string_view name);
const char* critical_angle_name(CriticalAngle treatment);

// A pair of directions in one plane with the normal, outside the coat. The steeper one is `far`; which of the two is
// the light does not matter (reciprocity).
struct InPlane {
  double cos_far = 1;     // 0..1
  double cos_near = 1;    // 0..1
  bool same_side = true;  // of the normal; where cos_near = 1 both are right
};

// The in-plane pair on the isoline of two unit directions above the surface (z >= 0). A pair that lies in plane is its
// own, to the last bits, at grazing angles too. Continuous in both directions.
InPlane equivalent_in_plane(const Vec3& to_light, const Vec3& to_viewer, double index, CriticalAngle treatment);

// Angles from the normal of a pair of directions in plane; the view's is negative across the normal from the light.
struct InPlaneAngles {
  double light_rad = 0, view_rad = 0;
};

// Variant with the light where `to_light` is the steeper one.
InPlaneAngles equivalent_in_plane_angles(const Vec3& to_light, const Vec3& to_viewer, double index,
                                         CriticalAngle treatment);

}  // namespace goniochrome::brdf
