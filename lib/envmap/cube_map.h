// Cube maps tell which direction a texel has and which texel a direction meets, how large a texel is on the sphere, and
// what lies between texels. The order of the faces (+X -X +Y -Y +Z -Z) and their orientation are OpenGL's; texel
// centers are at (i+.5)/N. goniochrome-prefiltering(7), "PREFILTERING".
#pragma once

#include <cstddef>
#include <vector>

#include "base/parallel.h"
#include "base/vec3.h"

namespace goniochrome::envmap {

// Six faces of N x N RGB texels, faces from the top, rows from the top: index ((face*N + row)*N + column)*3 + channel.
struct CubeMap {
  int size = 0;
  std::vector<float> texels;

  CubeMap() = default;
  explicit CubeMap(int n) : size(n), texels(static_cast<std::size_t>(n) * n * 18, 0.0F) {}
  float* at(int face, int row, int column) {
    return &texels[((static_cast<std::size_t>(face) * size + row) * size + column) * 3];
  }
  const float* at(int face, int row, int column) const {
    return &texels[((static_cast<std::size_t>(face) * size + row) * size + column) * 3];
  }
};

// The direction of s, t, 1 on a face whose axes s (columns) and t (rows) run from -1 to 1, times any number: of `stw`.
Vec3 cube_axes(int face, const Vec3& stw);

// Unit direction through (column, row) of a face of size n, in texels from its upper left corner; a center is at +.5.
Vec3 cube_direction(int face, double column, double row, int n);

// The face and the continuous (column, row) in texels that a direction meets.
struct CubePosition {
  int face = 0;
  double column = 0, row = 0;
};
CubePosition cube_position(const Vec3& direction, int n);

// Exact solid angle (sr) of the rectangle between the middle of a face and a point of it, signed as s t; and of the
// cell [s0,s1] x [t0,t1] of a face that spans -1..1; six faces are 4 pi.
double cube_corner_solid_angle(double s, double t);
double cube_cell_solid_angle(double s0, double s1, double t0, double t1);

// Bilinear lookup between texel centers, across face edges as OpenGL's seamless filtering does it (at a corner the
// three texels that meet there are averaged for the missing fourth).
Vec3 bilinear(const CubeMap& map, const Vec3& direction);

// Calls visit(face, row, column, direction) for each texel of faces of this size, on all cores.
template <class Visit>
void for_texels(int size, const Visit& visit) {
  parallel_each(static_cast<std::size_t>(6 * size), 8, [&](std::size_t line) {
    const int face = static_cast<int>(line) / size, row = static_cast<int>(line) % size;
    for (int column = 0; column < size; ++column)
      visit(face, row, column, cube_direction(face, column + 0.5, row + 0.5, size));
  });
}

// The map with faces of this size, by bilinear lookups.
CubeMap resized(const CubeMap& map, int size);

}  // namespace goniochrome::envmap
