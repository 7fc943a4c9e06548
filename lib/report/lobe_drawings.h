// Drawings of functions over the hemisphere, for reports about reflection: polar diagrams, surfaces in space, and
// squares of color.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/vec3.h"
#include "report/plot.h"

namespace goniochrome::report {

// Values over the angle from the normal in one plane, from -90 deg at the left to 90 deg at the right.
struct PolarSeries {
  std::string label = {};
  std::string color = {};
  std::vector<double> angle_deg = {}, radius = {};
  bool points = false;
};

// A polar diagram with the normal upward, and circles at round radii up to the largest value.
Drawing polar_drawing(const std::string& title, const std::vector<PolarSeries>& series, int width, int height);

// The surface at distance `radius` (at least 0) from the origin in each unit direction with z >= 0. It is seen from the
// side (x to the right, z up) and a little from above, and far parts are painted first. `arrow` is a direction that is
// drawn too: the direction to the light.
Drawing surface_drawing(const std::string& title, const std::string& color,
                        const std::function<double(const Vec3&)>& radius, const Vec3& arrow, int width, int height);

// n x n cells of color (display-referred, 0..1). `color` is asked at x and y in -1..1, y upward.
Drawing square_drawing(const std::string& title, int n, const std::function<Vec3(double x, double y)>& color, int width,
                       int height);

// The direction that belongs to a point of the square [-1,1]^2: the normal in the middle, grazing directions on the
// border. Shirley and Chiu's map takes the square to the disc, and the disc goes to the hemisphere by equal areas.
Vec3 hemisphere_direction(double x, double y);

}  // namespace goniochrome::report
