#include "brdf/sbrdf.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/angles.h"

namespace goniochrome::brdf::sbrdf_test {
namespace {

SbrdfTexture two_by_one() {
  return {2, 1, 1, {0.1F, 0.2F, 0.3F, 1,  0, 1,    1,    1,    -1, -1,   1,    20,   // x axis along the tangent
                    0,    0,    0,    -1, 0, 0.5F, 0.5F, 0.5F, -1, 0.5F, 0.9F, 4}};  // turned by 90 deg
}

TEST(Sbrdf, TexelsAreLobesInATurnedFrame) {
  const SbrdfTexture texture = two_by_one();
  const SbrdfTexel plain = sbrdf_texel(texture, 0, 0), turned = sbrdf_texel(texture, 1, 0);
  EXPECT_FLOAT_EQ(static_cast<float>(plain.surface.diffuse.y), 0.2F);
  EXPECT_EQ(plain.x_tangent, 1);
  EXPECT_NEAR(turned.x_tangent, 0, 1e-7);  // the sine of pi as a float
  EXPECT_NEAR(std::abs(turned.x_bitangent), 1, 1e-7);
  ASSERT_EQ(turned.surface.lobes.size(), 1u);
  EXPECT_EQ(turned.surface.lobes[0].exponent, 4);
  EXPECT_EQ(turned.surface.lobes[0].axes.x, -1);
}

TEST(Sbrdf, TapsRepeatAndBlend) {
  for (const auto& [u, v] : {std::pair{0.1, 0.7}, {-3.3, 12.5}, {1.0, 0.0}, {0.999999, -1e-9}}) {
    double sum = 0, x = 0;
    for (const TextureTap& tap : texture_taps(8, 4, u, v)) {
      EXPECT_GE(tap.column, 0);
      EXPECT_LT(tap.column, 8);
      EXPECT_GE(tap.row, 0);
      EXPECT_LT(tap.row, 4);
      sum += tap.weight;
      x += tap.weight * std::cos(2 * kPi * (tap.column + 0.5) / 8);
    }
    EXPECT_NEAR(sum, 1, 1e-12);
    EXPECT_NEAR(x, std::cos(2 * kPi * u), 0.08) << u;  // linear between samples 45 deg apart
  }
  // v is up: the top row holds v near 1.
  EXPECT_EQ(texture_taps(8, 4, 1.0 / 16, 7.0 / 8)[0].row, 0);
  EXPECT_NEAR(texture_taps(8, 4, 1.0 / 16, 7.0 / 8)[0].weight, 1, 1e-12);
}

TEST(Sbrdf, TapsOfPlacesBeyondAllNumbersAreTexels) {
  for (const double far : {1e300, -1e308, HUGE_VAL, -HUGE_VAL, std::nan("")}) {
    double sum = 0;
    for (const TextureTap& tap : texture_taps(7, 5, far, far)) {
      EXPECT_GE(tap.column, 0) << far;
      EXPECT_LT(tap.column, 7) << far;
      EXPECT_GE(tap.row, 0) << far;
      EXPECT_LT(tap.row, 5) << far;
      sum += tap.weight;
    }
    EXPECT_NEAR(sum, 1, 1e-12) << far;
  }
}

}  // namespace
}  // namespace goniochrome::brdf::sbrdf_test
