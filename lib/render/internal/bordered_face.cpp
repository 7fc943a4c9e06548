#include "render/internal/bordered_face.h"

#include <algorithm>

namespace goniochrome::render {

std::vector<float> bordered_face(const envmap::CubeMap& map, int face) {
  const int n = map.size, wide = n + 2;
  std::vector<float> texels(static_cast<std::size_t>(wide) * static_cast<std::size_t>(wide) * 3);
  const auto at = [&](int column, int row) {
    return &texels[(static_cast<std::size_t>(row + 1) * wide + column + 1) * 3];
  };
  // The center of a texel beside the face, in the plane of the face, lies less than half a texel from the center of the
  // neighbor's first texel, so the direction finds it.
  const auto across = [&](int column, int row) {
    const envmap::CubePosition p = envmap::cube_position(envmap::cube_direction(face, column + 0.5, row + 0.5, n), n);
    const auto inside = [&](double x) { return std::clamp(static_cast<int>(x), 0, n - 1); };
    std::copy_n(map.at(p.face, inside(p.row), inside(p.column)), 3, at(column, row));
  };
  for (int i = 0; i < n; ++i) {
    std::copy_n(map.at(face, i, 0), 3 * static_cast<std::size_t>(n), at(0, i));
    across(-1, i), across(n, i), across(i, -1), across(i, n);
  }
  for (const int row : {-1, n}) {
    for (const int column : {-1, n}) {
      const int x = std::clamp(column, 0, n - 1), y = std::clamp(row, 0, n - 1);
      for (int c = 0; c < 3; ++c) at(column, row)[c] = (at(x, row)[c] + at(column, y)[c] + at(x, y)[c]) / 3;
    }
  }
  return texels;
}

}  // namespace goniochrome::render
