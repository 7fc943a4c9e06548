#include "prefilter/internal/mirror.h"

#include <gtest/gtest.h>

#include <random>

#include "prefilter/exact_lobe.h"
#include "prefilter/internal/environments_for_test.h"

namespace goniochrome::prefilter::mirror_test {
namespace {

envmap::CubeMap mirror_map(const envmap::Environment& env, int n) {
  envmap::CubeMap map(n);
  map.texels = mirror_values(env, envmap::map_grid(envmap::SphereGrid::Layout::kCube, n), {});
  return map;
}

TEST(Mirror, KeepsFluxAndConstantsAndCopiesAnEqualCube) {
  for (const envmap::Environment& env : environments())
    for (const int n : {1, 2, 7, 16, 45}) {
      const envmap::Environment mirror = envmap::Environment::from_cube(mirror_map(env, n), "mirror");
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(mirror.flux()[c] / env.flux()[c], 1, 1e-4) << n;
    }
  const envmap::Environment cube = environments().back();
  const envmap::CubeMap same = mirror_map(cube, 45);
  for (int row = 0; row < 6 * 45; ++row)
    for (int column = 0; column < 45; ++column)
      EXPECT_FLOAT_EQ(same.at(row / 45, row % 45, column)[1], cube.radiance(column, row)[1]);
  image::Image one = {33, 16, 3, std::vector<float>(33 * 16 * 3, 2.5F), {}};
  const envmap::Environment constant =
      envmap::Environment::from_lat_long(one, envmap::Environment::BadPixels::kError, "one").value();
  for (const float v : mirror_map(constant, 9).texels) EXPECT_FLOAT_EQ(v, 2.5F);
}

TEST(Mirror, EqualsASearchAlongTheEdges) {
  for (const envmap::Environment& env : environments()) {
    envmap::PrefilteredLobe lobe;
    lobe.exponent = paint::kMirrorExponent;
    lobe.map = mirror_map(env, 12);
    const LobeError error = lobe_error(env, lobe, 24, 3, 3);
    // The search takes edges as straight over 1/128 of a texel, and a sun outshines the rest of its texel by 1e5.
    EXPECT_LT(error.max, 1e-3);
    EXPECT_LT(error.mean, 2e-5);
  }
}

}  // namespace
}  // namespace goniochrome::prefilter::mirror_test
