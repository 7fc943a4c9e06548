// Radiance is constant over a texel, so whatever is summed over an environment is summed over parts of texels. This
// header has such a part, and quadrature over it.
#pragma once

#include <array>
#include <cmath>

#include "base/vec3.h"
#include "envmap/environment.h"
#include "math/quadrature.h"

namespace goniochrome::envmap {

// A part of one texel, in continuous columns and rows.
struct Cell {
  double column0 = 0, row0 = 0, column1 = 0, row1 = 0;
};

// Calls body(direction, weight in sr) for the points of a rule each way over a cell.
template <class Body>
void for_each_node(const Environment& env, const Cell& cell, const math::GaussPoints& rule, const Body& body) {
  const double width = cell.column1 - cell.column0, height = cell.row1 - cell.row0;
  const auto row_of = [&](int j) { return cell.row0 + rule.at[j] * height; };
  const auto column_of = [&](int i) { return cell.column0 + rule.at[i] * width; };
  const SphereGrid& grid = env.grid();
  const bool is_lat_long = grid.layout() == SphereGrid::Layout::kLatLong;
  std::array<SphereGrid::Turn, 4> longitudes;
  for (int i = 0; is_lat_long && i < rule.count; ++i) longitudes[i] = grid.longitude(column_of(i));
  for (int j = 0; j < rule.count; ++j) {
    const SphereGrid::Turn polar_angle = is_lat_long ? grid.polar_angle(row_of(j)) : SphereGrid::Turn{};
    for (int i = 0; i < rule.count; ++i) {
      const double area = rule.weight[i] * rule.weight[j] * width * height;
      if (is_lat_long)
        body(SphereGrid::direction_at(polar_angle, longitudes[i]), area * grid.solid_angle_density(polar_angle));
      else
        body(grid.direction_at(column_of(i), row_of(j)), area * grid.solid_angle_density(column_of(i), row_of(j)));
    }
  }
}

// The integral of integrand(direction) over a cell, in sr, at the points of a rule each way.
template <class Integrand>
auto over_cell(const Environment& env, const Cell& cell, const math::GaussPoints& rule, const Integrand& integrand) {
  decltype(integrand(Vec3{})) sum{};
  for_each_node(env, cell, rule, [&](const Vec3& direction, double weight) { sum += weight * integrand(direction); });
  return sum;
}

inline std::array<Cell, 4> quarters(const Cell& c) {
  const double column = (c.column0 + c.column1) / 2, row = (c.row0 + c.row1) / 2;
  return {{{c.column0, c.row0, column, row},
           {column, c.row0, c.column1, row},
           {c.column0, row, column, c.row1},
           {column, row, c.column1, c.row1}}};
}

// The integral of the direction over a rectangle of the plane s, t, 1 that a cube's face lies in: of (s, t, 1) by the
// square of 1 + s^2 + t^2.
inline Vec3 moment_on_face(double s0, double s1, double t0, double t1) {
  const double radius = 0.5 * std::hypot(s1 - s0, t1 - t0);
  if (radius > 0.2) {
    const double s = (s0 + s1) / 2, t = (t0 + t1) / 2;
    return moment_on_face(s0, s, t0, t) + moment_on_face(s, s1, t0, t) + moment_on_face(s0, s, t, t1) +
           moment_on_face(s, s1, t, t1);
  }
  const math::GaussPoints& rule = math::kGaussPoints[radius > 0.01 ? 3 : 1];
  Vec3 sum;
  for (int j = 0; j < rule.count; ++j)
    for (int i = 0; i < rule.count; ++i) {
      const double s = s0 + rule.at[i] * (s1 - s0), t = t0 + rule.at[j] * (t1 - t0), square = 1 + s * s + t * t;
      sum += (rule.weight[i] * rule.weight[j] / (square * square)) * Vec3{s, t, 1};
    }
  return (s1 - s0) * (t1 - t0) * sum;
}

// The integral of the direction over a cell, in sr.
inline Vec3 moment_of_cell(const Environment& env, const Cell& cell) {
  const SphereGrid& grid = env.grid();
  if (grid.is_cube()) {
    const int face = static_cast<int>(std::floor(cell.row0 / grid.width())), first = face * grid.width();
    return cube_axes(face,
                     moment_on_face(grid.face_coordinate(cell.column0), grid.face_coordinate(cell.column1),
                                    grid.face_coordinate(cell.row0 - first), grid.face_coordinate(cell.row1 - first)));
  }
  const double radius = env.radius_rad(cell.column0, cell.row0, cell.column1, cell.row1);
  if (radius > 0.2) {
    Vec3 sum;
    for (const Cell& quarter : quarters(cell)) sum += moment_of_cell(env, quarter);
    return sum;
  }
  return over_cell(env, cell, math::kGaussPoints[radius > 0.01 ? 3 : 1], [](const Vec3& w) { return w; });
}

// The angle between two unit vectors, to the last digits for any two. Radians.
inline double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(length(cross(a, b)), dot(a, b));
}

}  // namespace goniochrome::envmap
