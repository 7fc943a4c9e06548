#include "sketch/probe.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/angles.h"

namespace goniochrome::sketch::probe_test {
namespace {

// One pixel that looks along -Z at a surface whose normal is turned by 20 degrees toward +X, and one beside it.
image::AovFile file_of(const color::Rgb& rgb, double stops) {
  image::AovFile file;
  file.path = "view.exr";
  const float gain = static_cast<float>(std::exp2(stops));
  const float r = gain * static_cast<float>(rgb.x), g = gain * static_cast<float>(rgb.y),
              b = gain * static_cast<float>(rgb.z);
  const float sine = static_cast<float>(std::sin(20 * kDegree)), cosine = static_cast<float>(std::cos(20 * kDegree));
  file.image = {2,
                1,
                8,
                {r, g, b, 1, sine, 0, cosine, 2, 0, 0, 0, 0, 0, 0, 0, 0},
                {"R", "G", "B", "A", "normal.X", "normal.Y", "normal.Z", "part"}};
  file.exposure_stops = stops, file.white_luminance = 2;
  file.has_rays = true;
  file.corner = {-1e-9, 0, -1}, file.right = {1e-9, 0, 0}, file.down = {0, 0, 0};
  file.parts = {"Glass", "Hood"}, file.materials = {"glass", "lacquer"};
  return file;
}

// By hand: the mirror direction of a viewer at 0 is turned by twice the normal's 20 degrees, to 40.
TEST(Probe, TellsThePartAndTheAngles) {
  image::AovFile file = file_of({0.4, 0.4, 0.4}, -1);
  file.lights.push_back({{0, 0, 1}});
  file.lights.push_back({{std::sin(65 * kDegree), 0, std::cos(65 * kDegree)}});
  const auto found = probe(file, 0, 0);
  ASSERT_TRUE(found.ok()) << found.error().message;
  EXPECT_EQ(found->part, "Hood");
  EXPECT_EQ(found->material, "lacquer");
  EXPECT_NEAR(found->view_deg, 20, 1e-5);  // normals are floats
  ASSERT_EQ(found->aspecular_deg.size(), 2u);
  EXPECT_NEAR(found->aspecular_deg[0], 40, 1e-5);
  EXPECT_NEAR(found->aspecular_deg[1], 25, 1e-5);
  EXPECT_NEAR(found->normal.x, std::sin(20 * kDegree), 1e-7);
  // 0.4 of a white of 2 is a reflectance of a fifth: L* = 116 (1/5)^(1/3) - 16.
  EXPECT_NEAR(found->rgb.y, 0.4, 1e-7);
  EXPECT_NEAR(found->lab.L, 116 * std::cbrt(0.2) - 16, 1e-4);
  EXPECT_NEAR(found->lab.a, 0, 1e-3);
}

TEST(Probe, BesideTheMeshHasAColorAlone) {
  const auto found = probe(file_of({1, 1, 1}, 0), 1, 0);
  ASSERT_TRUE(found.ok());
  EXPECT_FALSE(found->on_mesh);
  EXPECT_EQ(found->part, "");
  EXPECT_TRUE(found->aspecular_deg.empty());
}

TEST(Probe, OutsideOrWithoutBuffersIsAnError) {
  image::AovFile file = file_of({1, 1, 1}, 0);
  EXPECT_THAT(probe(file, 2, 0).error().message, testing::HasSubstr("2,0 lies outside of view.exr, which has 2 x 1"));
  EXPECT_FALSE(probe(file, 0, -1).ok());
  file.image.channel_names.back() = "mask";
  EXPECT_FALSE(probe(file, 0, 0).ok());
}

}  // namespace
}  // namespace goniochrome::sketch::probe_test
