// Drawings of functions over the hemisphere: polar diagrams, surfaces and squares of color.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/vec3.h"
#include "report/plot.h"

namespace goniochrome::report {

// Values over the angle from the normal in one plane, -90 deg at the left to 90 deg at the right.
struct PolarSeries {
  std::string label = {};
  std::string color = {};
  std::vector<double> angle_deg = {}, radius = {};
  bool points = false;
};

// A polar diagram with the normal upward. Circles at round radii up to the largest value.
Drawing polar_drawing(const std::string& title, const std::vector<PolarSeries>& series, int width, int height);

// The surface that `radius` (at least 0) spans over the hemisphere of unit directions with z >= 0, seen from the side
// (x to the right, z up) and a little from above; far parts are painted first. `arrow` is a direction to draw, such as
// the way to the light.
Drawing surface_drawing(const std::string& title, const std::string& color,
                        const std::function<double(const Vec3&)>& radius, const Vec3& arrow, int width, int height);

// n x n cells of color (display-referred, 0..1), `color` at x and y in -1..1, y upward.
Drawing square_drawing(const std::string& title, int n, const std::function<Vec3(double x, double y)>& color, int width,
                       int height);

// The direction of a point of the square [-1,1]^2 (Shirley and Chiu's map of the square to the disc, then the disc to
// the hemisphere by equal areas): the normal in the middle, grazing directions on the border.
Vec3 hemisphere_direction(double x, double y);

}  // namespace goniochrome::report
