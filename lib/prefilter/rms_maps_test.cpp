#include "prefilter/rms_maps.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/scratch_for_test.h"
#include "envmap/open_maps.h"

namespace goniochrome::prefilter::rms_maps_test {
namespace {

envmap::Environment lat_long(int rows, const std::function<Vec3(const Vec3&)>& radiance) {
  const envmap::SphereGrid grid(envmap::SphereGrid::Layout::kLatLong, 2 * rows, rows);
  image::Image image{2 * rows, rows, 3, {}, {"R", "G", "B"}};
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < 2 * rows; ++column)
      for (int c = 0; c < 3; ++c) image.data.push_back(static_cast<float>(radiance(grid.direction(column, row))[c]));
  return *envmap::Environment::from_lat_long(std::move(image), envmap::Environment::BadPixels::kError, "test");
}

envmap::PrefilteredEnvironment made(const envmap::Environment& light, const std::vector<double>& exponents) {
  PrefilterRequest request;
  request.exponents = exponents;
  auto env = prefiltered(light, request, prefilter_plan(light, request), [](const auto&, double) {});
  keep_rms_maps(light, request, env);
  return env;
}

TEST(RmsMaps, AreTheLightItselfWhereItIsEven) {
  const auto env = made(lat_long(32, [](const Vec3&) { return Vec3{2, 3, 4}; }), {6, 250});
  for (const envmap::PrefilteredLobe& lobe : env.lobes)
    for (std::size_t i = 0; i < lobe.rms->texels.size(); ++i)
      EXPECT_NEAR(lobe.rms->texels[i], 2 + static_cast<double>(i % 3), 4e-3) << lobe.exponent;
}

// Halves of 0 and 2 about the mean 1: the mean square is 2 where a lobe sees as much of both. Stripes that are much
// narrower than the lobe are seen so everywhere.
TEST(RmsMaps, HoldTheMeanSquare) {
  const auto env = made(lat_long(256,
                                 [](const Vec3& d) {
                                   const double bright = std::sin(60 * std::asin(d.y)) > 0 ? 2.0 : 0;
                                   return Vec3{bright, bright, bright};
                                 }),
                        {20});
  const Vec3 level = envmap::bilinear(*env.lobes[0].rms, {0.6, 0, 0.8});
  EXPECT_NEAR(level.x, std::sqrt(2), 0.03);
  EXPECT_NEAR(envmap::bilinear(env.lobes[0].map, {0.6, 0, 0.8}).x, 1, 0.03) << "the control is the mean";
}

TEST(RmsMaps, LackTheBrightSpots) {
  const auto sky = [](const Vec3& d) {
    const double sun = d.y > 0.998 ? 500 : 0;
    return Vec3{1 + sun, 1 + sun, 1 + sun};
  };
  const auto env = made(lat_long(128, sky), {20});
  ASSERT_FALSE(env.spots.empty());
  const Vec3 up = envmap::bilinear(*env.lobes[0].rms, {0, 1, 0});
  EXPECT_LT(up.x, 2);
  EXPECT_GT(up.x, 0.98);
}

TEST(RmsMaps, StayInTheFile) {
  const auto env = made(lat_long(32, [](const Vec3& d) { return Vec3{1 + d.x, 1, 1}; }), {6, 250});
  const ScratchFolder folder;
  ASSERT_TRUE(envmap::write_env(folder.path("a.env.exr"), env, "test").ok());
  const auto back = envmap::read_env(folder.path("a.env.exr"));
  ASSERT_TRUE(back.ok());
  for (const envmap::PrefilteredLobe& lobe : env.lobes) {
    const envmap::PrefilteredLobe* read = back->lobe(lobe.exponent);
    ASSERT_NE(read->rms, nullptr);
    ASSERT_EQ(read->rms->texels.size(), lobe.rms->texels.size());
    for (std::size_t i = 0; i < lobe.rms->texels.size(); ++i)
      EXPECT_NEAR(read->rms->texels[i], lobe.rms->texels[i], 1e-3 * lobe.rms->texels[i]);
    EXPECT_LE(lobe.rms->size, lobe.map.size);
  }
  const auto one = envmap::read_env(folder.path("a.env.exr"), [](double exponent) { return exponent == 6; });
  ASSERT_TRUE(one.ok());
  EXPECT_NE(one->lobe(6)->rms, nullptr);
}

}  // namespace
}  // namespace goniochrome::prefilter::rms_maps_test
