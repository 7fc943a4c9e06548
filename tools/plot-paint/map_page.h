// The drawing of a paint's color map.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "brdf/color_map.h"
#include "report/plot.h"

namespace goniochrome::tool {

// A reading within this distance covers a direction, in the degrees of brdf::ColorMap::distance_deg.
constexpr double kCovered_deg = 10;

// True if the map knows the color of unit directions above the surface from a reading near them: they are at least 10
// deg from specular and at most 75 deg from the normal, not beyond the critical angle where isolines are followed, and
// not farther than kCovered_deg from the nearest reading, if the map knows its distances.
bool is_covered(const brdf::ColorMap& map, const Vec3& to_light, const Vec3& to_viewer);

// A page of 1080 px: the colors in plane over the angles of light and viewer, and the hemisphere of viewers for lights
// at `incidence_deg`. Directions that are not covered are hatched.
report::Drawing map_page(const std::string& paint, const brdf::ColorMap& map, const std::vector<double>& incidence_deg);

}  // namespace goniochrome::tool
