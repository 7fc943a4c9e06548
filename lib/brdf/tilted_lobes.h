// Tilted lobes stand for a color map in image light, since prefiltered maps hold lobes alone. At each angle of the
// viewer they are a sum of cosine lobes about axes beside the mirror direction.
// goniochrome-interference(7), "TILTED LOBES".
#pragma once

#include "base/vec3.h"
#include "paint/paint.h"

namespace goniochrome::brdf {

// Nearer to the normal than this, a viewer sees axes that are tilted less. At the normal, where the plane of incidence
// has no direction, none is tilted.
constexpr double kFullTilt_deg = 15;

// The axis of a lobe for a viewer `view_deg` from the normal (0..90): a unit vector in the frame whose z is the normal
// and whose x lies in the plane of incidence, on the side of the mirror direction. Of a pair it is the one with y >= 0.
// It may lie below the surface.
Vec3 tilted_axis(const paint::TiltedLobe& lobe, double view_deg);

// The axis as a combination of vectors that need no frame: a r + s n + c (n x o) has its direction, where r is the
// mirror direction, n the normal and o the direction to the viewer; the other axis of a pair has -c. All three numbers
// are finite at every view, and at the normal the combination is n itself.
struct AxisSum {
  double a = 1, s = 0, c = 0;
};
AxisSum axis_sum(const paint::TiltedLobe& lobe, double view_deg);

// The weights of a set at one view: linear between two of its views, and constant beyond the ends. The set has views.
paint::TiltedView at_view(const paint::TiltedLobes& set, double view_deg);

// f cos_i in 1/sr of a set as prefiltered maps show it, for unit directions in the frame whose z is the normal. The
// lobes have no horizon of their own: what they send below it, f cos_i there, is told as well.
color::Rgb reflected_part(const paint::TiltedLobes& set, const Vec3& to_light, double view_deg);

}  // namespace goniochrome::brdf
