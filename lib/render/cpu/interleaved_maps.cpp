#include "render/cpu/interleaved_maps.h"

#include <algorithm>

#include "base/parallel.h"

namespace goniochrome::render {

namespace {

void put_face(const envmap::CubeMap& map, int face, std::size_t stride, float* to) {
  const int n = map.size, wide = n + 2;
  const auto at = [&](int column, int row) {
    return to + static_cast<std::size_t>((row + 1) * wide + column + 1) * stride;
  };
  const auto put = [&](const float* rgb, int column, int row) { *std::copy_n(rgb, 3, at(column, row)) = 0; };
  // The center of a texel beside the face, in the plane of the face, lies less than half a texel from the center of the
  // neighbor's first texel, so the direction finds it.
  const auto across = [&](int column, int row) {
    const envmap::CubePosition p = envmap::cube_position(envmap::cube_direction(face, column + 0.5, row + 0.5, n), n);
    const auto inside = [&](double x) { return std::clamp(static_cast<int>(x), 0, n - 1); };
    put(map.at(p.face, inside(p.row), inside(p.column)), column, row);
  };
  for (int i = 0; i < n; ++i) {
    for (int column = 0; column < n; ++column) put(map.at(face, i, column), column, i);
    across(-1, i), across(n, i), across(i, -1), across(i, n);
  }
  for (const int row : {-1, n}) {
    for (const int column : {-1, n}) {
      const int x = std::clamp(column, 0, n - 1), y = std::clamp(row, 0, n - 1);
      for (int c = 0; c < 4; ++c) at(column, row)[c] = (at(x, row)[c] + at(column, y)[c] + at(x, y)[c]) / 3;
    }
  }
}

}  // namespace

void put_bordered(const envmap::CubeMap& map, std::size_t stride, float* to) {
  parallel_each(6, 1, [&](std::size_t face) {
    put_face(map, static_cast<int>(face), stride, to + face * bordered_texels(map.size) / 6 * stride);
  });
}

ProductColumns product_columns(const color::ReflectionOperator& op) {
  ProductColumns columns{};
  for (std::size_t light = 0; light < 3; ++light)
    for (std::size_t paint = 0; paint < 3; ++paint)
      for (std::size_t c = 0; c < 3; ++c)
        columns[12 * light + 4 * paint + c] = static_cast<float>(op.k[c][light][paint]);
  return columns;
}

}  // namespace goniochrome::render
