// Reflection operators that were made for other primaries than those of the working space.
#include "color/internal/reflection_space.h"

#include <array>
#include <cmath>

namespace goniochrome::color {

namespace {

Xyz xyz_of(const std::array<double, 2>& xy, double Y) {
  return {Y * xy[0] / xy[1], Y, Y * (1 - xy[0] - xy[1]) / xy[1]};
}

// The matrix from values of an RGB space to working-space values: (1,1,1) goes to (1,1,1).
Result<Matrix3> to_working_space(const Primaries& source) {
  Matrix3 chromaticities{};
  for (std::size_t i = 0; i < 4; ++i) {
    const auto& xy = i < 3 ? source.rgb[i] : source.white;
    if (!std::isfinite(xy[0]) || !std::isfinite(xy[1]) || !(xy[1] > 0))
      return input_error("the chromaticity {},{} is none: x and y are numbers, and y is above 0", xy[0], xy[1]);
    if (i == 3) break;
    const Xyz xyz = xyz_of(xy, 1);
    chromaticities[0][i] = xyz.X, chromaticities[1][i] = xyz.Y, chromaticities[2][i] = xyz.Z;
  }
  const Inverse3 solved = inverse(chromaticities);
  if (solved.condition > 1e8) return input_error("the three primaries lie on one line");
  const Xyz white = xyz_of(source.white, 1), working_white = xyz_d65_from_rgb({1, 1, 1});
  const Rgb luminance = product(solved.matrix, {white.X, white.Y, white.Z});
  Matrix3 matrix{};
  for (int i = 0; i < 3; ++i) {
    const auto column = static_cast<std::size_t>(i);
    const Rgb primary = rgb_from_xyz_d65(adapted(xyz_of(source.rgb[column], luminance[i]), white, working_white));
    for (int c = 0; c < 3; ++c) matrix[static_cast<std::size_t>(c)][column] = primary[c];
  }
  return matrix;
}

// With M from the space of `op` to another one and m its inverse, A (x) B = M ((m A) (x) (m B)), which is bilinear with
// k'[i][j][l] = sum M[i][c] k[c][d][e] m[d][j] m[e][l]. Rounding is taken away by the nearest coherent table.
ReflectionOperator carried(const ReflectionOperator& op, const Matrix3& there, const Matrix3& back) {
  ReflectionOperator result;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t l = 0; l < 3; ++l)
        for (std::size_t c = 0; c < 3; ++c)
          for (std::size_t d = 0; d < 3; ++d)
            for (std::size_t e = 0; e < 3; ++e)
              result.k[i][j][l] += there[i][c] * op.k[c][d][e] * back[d][j] * back[e][l];
  return nearest_coherent(result);
}

// The matrix to the working space and its inverse.
Result<std::array<Matrix3, 2>> both_ways(const Primaries& source) {
  GONIO_ASSIGN(const Matrix3 there, to_working_space(source));
  const Inverse3 back = inverse(there);
  if (back.condition > 1e8) return input_error("the three primaries lie on one line, or the white is one of them");
  return std::array{there, back.matrix};
}

}  // namespace

Result<ReflectionOperator> in_working_space(const ReflectionOperator& op, const Primaries& source) {
  GONIO_ASSIGN(const auto ways, both_ways(source));
  return carried(op, ways[0], ways[1]);
}

Result<ReflectionOperator> in_primaries(const ReflectionOperator& op, const Primaries& target) {
  GONIO_ASSIGN(const auto ways, both_ways(target));
  return carried(op, ways[1], ways[0]);
}

}  // namespace goniochrome::color
