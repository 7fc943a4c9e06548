#include "envmap/cube_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/angles.h"
#include "base/hard_case_for_test.h"

namespace goniochrome::envmap::cube_map_test {
namespace {

Vec3 random_direction(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return normalized({normal(random), normal(random), normal(random)});
}

TEST(CubeMap, PositionUndoesDirection) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 20000; ++i) {
    const Vec3 d = random_direction(random);
    const CubePosition p = cube_position(d, 37);
    const Vec3 back = cube_direction(p.face, p.column, p.row, 37);
    EXPECT_LT(length(back - d), 1e-15);  // a few ulps of 1
  }
}

TEST(CubeMap, FacesPointAlongTheirAxes) {
  const Vec3 axes[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  for (int face = 0; face < 6; ++face) EXPECT_EQ(cube_direction(face, 2, 2, 4), axes[face]);
}

TEST(CubeMap, SolidAnglesSumToTheSphere) {
  for (const int n : {1, 2, 3, 16, 255, 1024}) {
    const auto edge = [n](int i) { return 2.0 * i / n - 1; };
    double sum = 0;
    for (int row = 0; row < n; ++row)
      for (int column = 0; column < n; ++column)
        sum += cube_cell_solid_angle(edge(column), edge(column + 1), edge(row), edge(row + 1));
    EXPECT_NEAR(6 * sum / (4 * kPi), 1, 1e-13 * n) << n;  // n^2 texels, each off by some 1e-16 absolute
  }
}

// A smooth function is met within h^2/8 of its curvature everywhere, across edges and corners too.
TEST(HardCase, PrefilterSeamLookupIsContinuousAcrossEdgesAndCorners) {
  constexpr int kSize = 32;
  const auto scene = [](const Vec3& d) { return 2 + d.x + 0.5 * d.y - 0.25 * d.z; };
  CubeMap map(kSize);
  for (int face = 0; face < 6; ++face)
    for (int row = 0; row < kSize; ++row)
      for (int column = 0; column < kSize; ++column)
        for (int c = 0; c < 3; ++c)
          map.at(face, row, column)[c] =
              static_cast<float>(scene(cube_direction(face, column + 0.5, row + 0.5, kSize)));
  // Within half a texel of an edge the neighbor's texel is not where the plane of the face goes on: an error of up to
  // half a texel (1/32) times the slope (1.15) times the weight (1/2).
  const auto clamped = [&](const Vec3& d) {  // the textbook lookup, face by face
    const CubePosition p = cube_position(d, kSize);
    const auto inside = [&](int i) { return i < 0 ? 0 : i < kSize ? i : kSize - 1; };
    const double x = p.column - 0.5, y = p.row - 0.5;
    const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
    const auto at = [&](int a, int b) { return map.at(p.face, inside(b), inside(a))[0]; };
    return (1 - y + j) * ((1 - x + i) * at(i, j) + (x - i) * at(i + 1, j)) +
           (y - j) * ((1 - x + i) * at(i, j + 1) + (x - i) * at(i + 1, j + 1));
  };
  std::mt19937_64 random(2);
  double worst = 0, worst_step = 0, worst_clamped_step = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 d = random_direction(random);
    worst = worst_of(worst, std::fabs(bilinear(map, d).x - scene(d)));
    // A pair of directions on either side of the edge between +X and +Z.
    const double y = d.y;
    const Vec3 a = normalized({1 + 1e-9, y, 1}), b = normalized({1, y, 1 + 1e-9});
    worst_step = worst_of(worst_step, std::fabs(bilinear(map, a).x - bilinear(map, b).x));
    worst_clamped_step = worst_of(worst_clamped_step, std::fabs(clamped(a) - clamped(b)));
  }
  EXPECT_LT(worst, 1.15 / 32 / 2);
  hard_case("prefilter-seam", {.what = "step of a lookup across the edge of two faces",
                               .textbook = worst_clamped_step,
                               .ours = worst_step,
                               .bound = 1e-6,
                               .unit = "radiance"});
}

TEST(CubeMap, LookupOfOneTexelFacesIsFinite) {
  CubeMap map(1);
  for (float& v : map.texels) v = 3;
  std::mt19937_64 random(3);
  for (int i = 0; i < 1000; ++i) EXPECT_NEAR(bilinear(map, random_direction(random)).y, 3, 1e-12);
}

}  // namespace
}  // namespace goniochrome::envmap::cube_map_test
