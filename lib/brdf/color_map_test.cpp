#include "brdf/color_map.h"

#include <gtest/gtest.h>

#include <cmath>

namespace goniochrome {
namespace {

TEST(ColorMap, TexelsStandForTheirDirections) {
  constexpr int kSize = 16;
  for (int row = 0; row < 2 * kSize; ++row) {
    for (int column = 0; column < kSize; ++column) {
      const MapDirections d = map_directions(kSize, column, row);
      EXPECT_NEAR(length(d.light), 1, 1e-15);
      EXPECT_EQ(row < kSize, d.view.x < 0);
      // Only one order of the pair is looked up: the steeper direction is the column.
      if (d.light.z > d.view.z) continue;
      const MapPlace place = map_place(equivalent_in_plane(d.light, d.view, 1.5, CriticalAngle::kClip), kSize);
      EXPECT_NEAR(place.x, column + 0.5, 1e-12);
      EXPECT_NEAR(place.y, row + 0.5, 1e-12);
    }
  }
}

TEST(ColorMap, GlossLineIsTheDiagonalOfTheUpperHalf) {
  for (const double t : {0.1, 0.7, 1.4}) {
    const Vec3 light = {std::sin(t), 0, std::cos(t)}, mirror = {-std::sin(t), 0, std::cos(t)};
    const MapPlace place = map_place(equivalent_in_plane(light, mirror, 1.5, CriticalAngle::kClip), 100);
    EXPECT_NEAR(place.x, place.y, 1e-10);
  }
}

// A map that is linear in both cosines comes back as it is, between texels too.
TEST(ColorMap, FetchIsBilinear) {
  ColorMap map = color_map_of_size(8, 1.5);
  for (int row = 0; row < 16; ++row)
    for (int column = 0; column < 8; ++column) {
      float* t = map.texel(column, row);
      t[0] = static_cast<float>(column + 0.5), t[1] = static_cast<float>(row + 0.5), t[2] = 1;
    }
  const Rgb value = fetched(map, {3.3, 9.75});
  EXPECT_NEAR(value.x, 3.3, 1e-6);
  EXPECT_NEAR(value.y, 9.75, 1e-6);
  EXPECT_NEAR(value.z, 1, 1e-6);
  EXPECT_EQ(fetched(map, {-4, 99}), (Rgb{0.5, 15.5, 1}));
  EXPECT_EQ(fetched(color_map_of_size(1, 1.5), {0.4, 1.7}), Rgb{});
  EXPECT_EQ(reflectance_factor(map, {0, 0, -1}, {0, 0, 1}, CriticalAngle::kClip), Rgb{});
  EXPECT_GT(reflectance_factor(map, {0, 0, 1}, {0, 0, 1}, CriticalAngle::kClip).x, 7);
}

}  // namespace
}  // namespace goniochrome
