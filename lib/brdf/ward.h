// Ward's anisotropic lobe reflects light off brushed surfaces. Prefiltered maps hold isotropic lobes only, so it is
// resolved into such lobes about tilted normals. goniochrome-lobes(7), "ANISOTROPY"; [Ward1992], [Shimizu2009] 2.5.3
#pragma once

#include <vector>

#include "base/result.h"
#include "base/vec3.h"
#include "paint/paint.h"

namespace goniochrome::brdf {

// f in 1/sr of a lobe of strength 1 with slope distributions alpha_x and alpha_y along the tangents x and y, in the
// frame z = normal; 0 where a direction is below the surface. It is finite at grazing angles and reciprocal, and it
// creates no light: the integral of f cos_i is at most 1 for every viewer and every alpha > 0.
double ward(const Vec3& to_light, const Vec3& to_viewer, const paint::Anisotropy& alpha);

// A normal to mirror the view about, in the frame of ward(), and its share of the light.
struct Tilt {
  Vec3 normal;
  double weight = 1;
};

// Tilts about the narrow axis that turn an isotropic lobe of `narrow_alpha` into one of `alpha`; weights sum to 1.
struct TiltSet {
  std::vector<Tilt> tilts;
  double narrow_alpha = 0;  // of the isotropic lobe, the smaller alpha or more
  double error = 0;         // bound, relative to the peak, over half vectors; more than asked at `max_count`
};

constexpr int kMostTilts = 8192;

// The fewest tilts whose error is at most `tolerance` (0..1, exclusive), or `max_count` of them. `narrow_alpha` is the
// width of the isotropic lobe that is drawn, at least the smaller alpha: lobe_alpha() of the sharpest lobe in use. One
// tilt where the lobe is isotropic. Error: alpha not positive.
Result<TiltSet> ward_tilts(const paint::Anisotropy& alpha, double narrow_alpha, double tolerance,
                           int max_count = kMostTilts);

// The Ward alpha as wide as cos^E of the aspecular angle: sqrt(1/(2E)), E > 0.
double lobe_alpha(double exponent);

}  // namespace goniochrome::brdf
