#include "sketch/internal/sketch_residual.h"

#include <gtest/gtest.h>

#include <cmath>

namespace goniochrome::sketch::sketch_residual_test {
namespace {

// A row of pixels at these aspecular angles.
image::AovFile row_of(const std::vector<float>& aspecular_deg) {
  image::AovFile file;
  file.image = {static_cast<int>(aspecular_deg.size()), 1, 1, aspecular_deg, {"aspecular"}};
  return file;
}

std::vector<std::uint32_t> all_of(const image::AovFile& file) {
  std::vector<std::uint32_t> places;
  for (int x = 0; x < file.image.width; ++x) places.push_back(static_cast<std::uint32_t>(x));
  return places;
}

// The picture is lighter than the paint by 3, 5 and 4 near specular, and bluer by 2 far from it.
PixelPair pair(std::size_t i) {
  const color::Lab shown{50, 0, 0};
  const color::Lab seen[] = {{53, 0, 0}, {55, 0, 0}, {54, 0, 0}, {50, 0, -2}};
  return {seen[i], shown};
}

TEST(SketchResidual, EachTenDegreesHaveTheirOwn) {
  const image::AovFile file = row_of({21, 25, 29, 110});
  SketchFit fit;
  take_residual(file, all_of(file), pair, false, fit);
  EXPECT_EQ(fit.residual_angle, "aspecular");
  ASSERT_EQ(fit.residual.size(), 2U);
  EXPECT_EQ(fit.residual[0].from_deg, 20);
  EXPECT_EQ(fit.residual[0].to_deg, 30);
  EXPECT_EQ(fit.residual[0].pixels, 3U);
  EXPECT_DOUBLE_EQ(fit.residual[0].median_de76, 4);
  EXPECT_DOUBLE_EQ(fit.residual[0].mean.L, 4);
  EXPECT_EQ(fit.residual[1].from_deg, 110);
  EXPECT_DOUBLE_EQ(fit.residual[1].mean.b, -2);
  EXPECT_DOUBLE_EQ(fit.rms_de76, std::sqrt((9 + 25 + 16 + 4) / 4.0));
  EXPECT_TRUE(fit.pixels.empty());
}

// A picture under an environment has no angle from specular, and neither normals nor rays here.
TEST(SketchResidual, BuffersWithoutAnglesHaveNone) {
  image::AovFile file = row_of({21, 25, 29, 110});
  file.environment = "studio.env.exr";
  SketchFit fit;
  take_residual(file, all_of(file), pair, true, fit);
  EXPECT_EQ(fit.residual_angle, "");
  EXPECT_TRUE(fit.residual.empty());
  EXPECT_DOUBLE_EQ(fit.median_de76, 4);  // of 2, 3, 4 and 5
  EXPECT_EQ(fit.pixels.size(), 4U);
}

// Normals that face the camera and lean away from it by 60 deg: bins of the viewer's angle.
TEST(SketchResidual, OtherLightGoesByTheViewersAngle) {
  image::AovFile file;
  file.environment = "studio.env.exr", file.has_rays = true, file.corner = {0, 0, -1};
  const float sine = 0.8660254F;
  file.image = {2, 1, 3, {0, 0, 1, sine, 0, 0.5F}, {"normal.X", "normal.Y", "normal.Z"}};
  SketchFit fit;
  take_residual(file, all_of(file), pair, false, fit);
  EXPECT_EQ(fit.residual_angle, "view");
  ASSERT_EQ(fit.residual.size(), 2U);
  EXPECT_EQ(fit.residual[0].from_deg, 0);
  EXPECT_EQ(fit.residual[1].to_deg - fit.residual[1].from_deg, 10);
  EXPECT_NEAR(fit.residual[1].from_deg, 55, 5);
}

}  // namespace
}  // namespace goniochrome::sketch::sketch_residual_test
