#include "envmap/internal/weighted_diffuse.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/angles.h"

namespace goniochrome::envmap::weighted_diffuse_test {
namespace {

template <class Radiance>
CubeMap cube(int n, const Radiance& radiance) {
  CubeMap map(n);
  for (int face = 0; face < 6; ++face)
    for (int row = 0; row < n; ++row)
      for (int column = 0; column < n; ++column) {
        const Vec3 value = radiance(cube_direction(face, column + 0.5, row + 0.5, n));
        for (int c = 0; c < 3; ++c) map.at(face, row, column)[c] = static_cast<float>(value[c]);
      }
  return map;
}

// The share falls as the coat's: nothing comes from grazing directions.
double share(double c) {
  const double d = 1 - c;
  return 1 - d * d * d * d * d;
}

TEST(WeightedDiffuse, AConstantEnvironmentStaysItself) {
  PrefilteredEnvironment env;
  env.diffuse.map = env.mirror.map = cube(32, [](const Vec3&) { return Vec3{1, 0.5, 2}; });
  const CubeMap map = weighted_diffuse(env, share);
  for (std::size_t i = 0; i < map.texels.size(); i += 3) {
    EXPECT_NEAR(map.texels[i], 1, 2e-3);
    EXPECT_NEAR(map.texels[i + 1], 0.5, 1e-3);
    EXPECT_NEAR(map.texels[i + 2], 2, 4e-3);
  }
}

// A sun and a sky, summed texel by texel for normals all around. The control is the diffuse map itself.
TEST(WeightedDiffuse, IsTheSumOverTheEnvironment) {
  const Vec3 sun = normalized({0.3, 0.6, -0.7});
  const auto radiance = [&](const Vec3& d) {
    const double glow = 40 * std::exp(200 * (dot(d, sun) - 1));
    return Vec3{0.05 + glow, 0.05 + 0.02 * d.y + 0.8 * glow, 0.05 + 0.03 * d.y + 0.5 * glow};
  };
  PrefilteredEnvironment env;
  const int n = 32;
  env.mirror.map = cube(n, radiance);
  const auto summed = [&](const Vec3& normal, bool weighted) {
    Vec3 sum;
    const double all = weighted ? 10.0 / 21 : 0.5;  // of the weighted cosine from 0 to 1
    for (int face = 0; face < 6; ++face)
      for (int row = 0; row < n; ++row)
        for (int column = 0; column < n; ++column) {
          const Vec3 d = cube_direction(face, column + 0.5, row + 0.5, n);
          const double c = dot(d, normal), s = 2.0 / n;
          if (c <= 0) continue;
          const double area = cube_cell_solid_angle(s * column - 1, s * column + s - 1, s * row - 1, s * row + s - 1);
          sum += (area * c * (weighted ? share(c) : 1) / (2 * kPi * all)) * radiance(d);
        }
    return sum;
  };
  env.diffuse.map = cube(16, [&](const Vec3& d) { return summed(d, false); });
  const CubeMap map = weighted_diffuse(env, share);
  double worst = 0, control = 0, brightest = 0;
  for (int i = 0; i < 60; ++i) {
    const double z = 1 - 2 * (i + 0.5) / 60, s = std::sqrt(1 - z * z), p = 2.4 * i;
    const Vec3 normal{s * std::cos(p), z, s * std::sin(p)};
    const Vec3 truth = summed(normal, true), got = bilinear(map, normal), plain = bilinear(env.diffuse.map, normal);
    worst = std::max(worst, std::abs(got.y - truth.y));
    control = std::max(control, std::abs(plain.y - truth.y));
    brightest = std::max(brightest, truth.y);
  }
  EXPECT_LE(worst, 0.01 * brightest);
  EXPECT_GT(control, 0.04 * brightest);
}

}  // namespace
}  // namespace goniochrome::envmap::weighted_diffuse_test
