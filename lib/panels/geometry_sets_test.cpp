#include "panels/geometry_sets.h"

#include <gmock/gmock.h>

namespace goniochrome::panels::geometry_sets_test {
namespace {

TEST(GeometrySets, TakeListsRangesNamesAndAspecularViews) {
  const GeometryList list = *geometry_list({.lights = "0:60:30,45", .views = "as25,-10", .azimuths = "0,90"});
  EXPECT_EQ(list.pairs.size(), 16u);
  EXPECT_EQ(list.pairs[0].view_deg, -25);
  for (const GeometrySet& set : geometry_sets()) {
    const auto named =
        geometry_list({.lights = std::string("set:") + set.name, .views = std::string("set:") + set.name});
    ASSERT_TRUE(named.ok()) << set.name;
    EXPECT_GE(named->pairs.size(), 5u);
  }
  const GeometryList some = *geometry_list({.lights = "45", .views = "45,40,as80,as140", .azimuths = "0"});
  EXPECT_EQ(some.glare, 2);
  ASSERT_EQ(some.left_out.size(), 2u);
  EXPECT_EQ(some.left_out[0].view_deg, 45);
  EXPECT_EQ(some.left_out[1].view_deg, 40);
  EXPECT_EQ(some.below_horizon, 1);
  EXPECT_EQ(some.pairs.size(), 1u);
  const GeometryList heavy = *geometry_list(
      {.lights = "30,45", .views = "as25,as45", .azimuths = "0", .light_weights = {1, 3}, .view_weights = {2, 1}});
  EXPECT_EQ(heavy.weights, (std::vector<double>{2, 1, 6, 3}));
}

TEST(GeometrySets, ErrorsNameOptionValueAndRemedy) {
  const auto message = [](const GeometryTexts& texts) { return geometry_list(texts).error().message; };
  EXPECT_THAT(message({.lights = "95"}), testing::HasSubstr("--lights has 95: that light is below the horizon"));
  EXPECT_THAT(message({.lights = "-5"}), testing::HasSubstr("0 up to less than 90"));
  EXPECT_THAT(message({.views = "90"}), testing::HasSubstr("--views has 90"));
  EXPECT_THAT(message({.lights = "1,x"}), testing::HasSubstr("--lights has \"x\""));
  EXPECT_THAT(message({.lights = "0:45"}), testing::HasSubstr("FIRST:LAST:STEP"));
  EXPECT_THAT(message({.lights = "0:45:0"}), testing::HasSubstr("step 0"));
  EXPECT_THAT(message({.views = "set:garage"}), testing::HasSubstr("instrument, showroom, outdoor"));
  EXPECT_THAT(message({.light_weights = {1, 2}}), testing::HasSubstr("2 weights for 1 angles"));
  EXPECT_THAT(message({.view_weights = {1, 1, 0, 1, 1}}), testing::HasSubstr("the weight 0"));
  EXPECT_THAT(message({.lights = "45", .views = "45"}), testing::HasSubstr("no pair of light and viewer is left"));
}

}  // namespace
}  // namespace goniochrome::panels::geometry_sets_test
