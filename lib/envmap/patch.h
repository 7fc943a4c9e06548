// The integral of a cosine lobe over a part of a texel: the constant patch that every method here means.
// goniochrome-theory(7), PREFILTERING, The reference.
#pragma once

#include "base/vec3.h"
#include "envmap/environment.h"

namespace goniochrome::envmap {

// A part of one texel in continuous columns and rows.
struct Cell {
  double column0 = 0, row0 = 0, column1 = 0, row1 = 0;
};

// The integral of max(0, d.w)^E over the cell (sr), to about `relative` of itself: Gauss-Legendre where the lobe is
// smooth over the cell, quarters where it is narrower than the cell. A cell that the horizon cuts is taken to about
// `at_horizon` of itself, as pieces on which the cosine is linear.
double lobe_over_cell(const Environment& env, const Cell& cell, const Vec3& d, double exponent, double relative,
                      double at_horizon);

// The mean of max(0, t)^E over a parallelogram on which t is linear: t0 in the middle, changing by a and b from side to
// side.
double linear_mean(double t0, double a, double b, double exponent);

// The integral of w over the cell.
Vec3 moment_of_cell(const Environment& env, const Cell& cell);

// The angle between two unit vectors, to the last digits for any two. Radians.
inline double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(length(cross(a, b)), dot(a, b));
}

}  // namespace goniochrome::envmap
