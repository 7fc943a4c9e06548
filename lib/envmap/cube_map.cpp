#include "envmap/cube_map.h"

#include <algorithm>
#include <cmath>

namespace goniochrome::envmap {

// OpenGL 4.5 core, table 8.19: a face with its axes s (columns) and t (rows), both from -1 to 1. Read backwards:
//   +X: (1,-t,-s)  -X: (-1,-t,s)  +Y: (s,1,t)  -Y: (s,-1,-t)  +Z: (s,-t,1)  -Z: (-s,-t,-1)
Vec3 cube_axes(int face, const Vec3& stw) {
  const auto& [s, t, w] = stw;
  switch (face) {
    case 0:
      return {w, -t, -s};
    case 1:
      return {-w, -t, s};
    case 2:
      return {s, w, t};
    case 3:
      return {s, -w, -t};
    case 4:
      return {s, -t, w};
    default:
      return {-s, -t, -w};
  }
}

Vec3 cube_direction(int face, double column, double row, int n) {
  return normalized(cube_axes(face, {2 * column / n - 1, 2 * row / n - 1, 1}));
}

CubePosition cube_position(const Vec3& d, int n) {
  const double x = std::fabs(d.x), y = std::fabs(d.y), z = std::fabs(d.z);
  int face = 0;
  double s = 0, t = 0;
  if (x >= y && x >= z) {
    face = d.x < 0 ? 1 : 0;
    s = (face ? d.z : -d.z) / x, t = -d.y / x;
  } else if (y >= z) {
    face = d.y < 0 ? 3 : 2;
    s = d.x / y, t = (face == 3 ? -d.z : d.z) / y;
  } else {
    face = d.z < 0 ? 5 : 4;
    s = (face == 5 ? -d.x : d.x) / z, t = -d.y / z;
  }
  return {face, (s + 1) * n / 2, (t + 1) * n / 2};
}

// The solid angle of the rectangle [0,s] x [0,t] of the plane at distance 1 is atan(s t / sqrt(1 + s^2 + t^2)).
double cube_corner_solid_angle(double s, double t) {
  return std::atan2(s * t, std::sqrt(s * s + t * t + 1));
}

double cube_cell_solid_angle(double s0, double s1, double t0, double t1) {
  return cube_corner_solid_angle(s1, t1) - cube_corner_solid_angle(s0, t1) - cube_corner_solid_angle(s1, t0) +
         cube_corner_solid_angle(s0, t0);
}

namespace {

// The texel beside a face: its center, in the plane of the face, lies less than half a texel from the center of the
// neighbor's first texel, so the direction finds it.
Vec3 texel_across(const CubeMap& map, int face, int column, int row) {
  const CubePosition p = cube_position(cube_direction(face, column + 0.5, row + 0.5, map.size), map.size);
  const auto inside = [&](double x) { return std::clamp(static_cast<int>(x), 0, map.size - 1); };
  return vec3(map.at(p.face, inside(p.row), inside(p.column)));
}

}  // namespace

Vec3 bilinear(const CubeMap& map, const Vec3& direction) {
  const int n = map.size;
  const CubePosition p = cube_position(direction, n);
  const double x = p.column - 0.5, y = p.row - 0.5;
  const int column = static_cast<int>(std::floor(x)), row = static_cast<int>(std::floor(y));
  const double fx = x - column, fy = y - row;
  const auto outside = [n](int i) { return i < 0 || i >= n; };
  Vec3 corner[2][2];
  int missing_x = -1, missing_y = -1;
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) {
      const bool out_x = outside(column + i), out_y = outside(row + j);
      if (out_x && out_y)
        missing_x = i, missing_y = j;
      else
        corner[j][i] =
            out_x || out_y ? texel_across(map, p.face, column + i, row + j) : vec3(map.at(p.face, row + j, column + i));
    }
  if (missing_x >= 0) {
    const int i = missing_x, j = missing_y;
    corner[j][i] = (1.0 / 3) * (corner[1 - j][i] + corner[j][1 - i] + corner[1 - j][1 - i]);
  }
  return (1 - fy) * ((1 - fx) * corner[0][0] + fx * corner[0][1]) + fy * ((1 - fx) * corner[1][0] + fx * corner[1][1]);
}

CubeMap resized(const CubeMap& map, int size) {
  CubeMap result(size);
  for_texels(size, [&](int face, int row, int column, const Vec3& direction) {
    const Vec3 value = bilinear(map, direction);
    for (int c = 0; c < 3; ++c) result.at(face, row, column)[c] = static_cast<float>(value[c]);
  });
  return result;
}

}  // namespace goniochrome::envmap
