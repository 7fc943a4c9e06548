// For tests: the windows of a gloss meter (ISO 2813), and a dense product rule over them.
#pragma once

#include <cmath>
#include <vector>

#include "base/angles.h"
#include "base/vec3.h"
#include "math/quadrature.h"

namespace goniochrome::brdf {

struct TestMeter {
  double angle_deg, receptor_par_deg, receptor_perp_deg;
};
inline constexpr TestMeter kTestMeters[] = {{20, 1.8, 3.6}, {60, 4.4, 11.7}, {85, 4, 6}};
constexpr double kSourceParallel_deg = 0.75, kSourcePerpendicular_deg = 2.5;

struct WindowPoint {
  Vec3 w;  // unit
  double solid_angle;
};

// n x n points of a window about the mirror direction of the meter, whose sides are these angles.
inline std::vector<WindowPoint> window_points(double angle_deg, double par_deg, double perp_deg, int n) {
  const double t = angle_deg * kDegree;
  const Vec3 s = {std::sin(t), 0, std::cos(t)}, u = {std::cos(t), 0, -std::sin(t)}, v = {0, 1, 0};
  std::vector<WindowPoint> points;
  const double a = std::tan(par_deg / 2 * kDegree), b = std::tan(perp_deg / 2 * kDegree);
  for (const auto& [x, wx] : math::gauss_legendre(n))
    for (const auto& [y, wy] : math::gauss_legendre(n)) {
      const Vec3 d = s + (a * x) * u + (b * y) * v;
      points.push_back({normalized(d), wx * wy * a * b / std::pow(length(d), 3)});
    }
  return points;
}

}  // namespace goniochrome::brdf
