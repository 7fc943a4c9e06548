#include "envmap/bright_spots.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "base/angles.h"

namespace goniochrome::envmap::bright_spots_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

Environment lat_long(int width, const std::function<Vec3(const Vec3& direction)>& radiance) {
  image::Image image{width, width / 2, 3, {}, {}};
  const SphereGrid grid(SphereGrid::Layout::kLatLong, width, width / 2);
  for (int row = 0; row < width / 2; ++row)
    for (int column = 0; column < width; ++column)
      for (int c = 0; c < 3; ++c) image.data.push_back(static_cast<float>(radiance(grid.direction(column, row))[c]));
  return *Environment::from_lat_long(std::move(image), Environment::BadPixels::kError, "made");
}

// A disc of radiance (1, .5, .25) * light on a sky that is darker below.
Environment disc_on_sky(const Vec3& direction, double radius_rad, double light, int width = 1024) {
  return lat_long(width, [=](const Vec3& d) {
    const Vec3 sky = (0.5 + 0.4 * d.y) * Vec3{0.6, 0.8, 1};
    return dot(d, direction) > std::cos(radius_rad) ? sky + light * Vec3{1, 0.5, 0.25} : sky;
  });
}

// The irradiance on a surface with this normal, texel by texel.
Vec3 irradiance(const Environment& environment, const Vec3& normal) {
  Vec3 sum;
  for (int row = 0; row < environment.height(); ++row)
    for (int column = 0; column < environment.width(); ++column) {
      const double cosine = dot(normal, environment.direction(column, row));
      const float* rgb = environment.radiance(column, row);
      if (cosine > 0) sum += cosine * environment.solid_angle(column, row) * Vec3{rgb[0], rgb[1], rgb[2]};
    }
  return sum;
}

// A texel of the map is .18 deg wide, so that the rim of the disc is known to a part of that, and its area to 6 %.
TEST(BrightSpots, FindADiscAsItIs) {
  const Vec3 direction = normalized({0.5, 0.6, -0.4});
  const double radius = 1 * kDegree, light = 4500;
  const std::vector<Spot> spots = bright_spots(disc_on_sky(direction, radius, light, 2048));
  ASSERT_THAT(spots, SizeIs(1));
  EXPECT_GT(dot(spots[0].direction, direction), std::cos(0.1 * kDegree));
  EXPECT_NEAR(spots[0].radius_rad, radius, 0.03 * radius);
  const double white = light * std::sin(radius) * std::sin(radius);  // irradiance / pi
  EXPECT_NEAR(spots[0].white.x, white, 0.06 * white);
  EXPECT_NEAR(spots[0].white.z, 0.25 * white, 0.015 * white);
}

TEST(BrightSpots, AStripIsCutIntoCompactSpots) {
  const Environment strip = lat_long(512, [](const Vec3& d) {
    const bool lit = std::abs(d.y - 0.5) < 0.03 && d.z > 0.3;
    return lit ? Vec3{80, 80, 80} : Vec3{0.3, 0.3, 0.3};
  });
  const std::vector<Spot> spots = bright_spots(strip);
  EXPECT_GE(spots.size(), 8U);
  double light = 0;
  for (const Spot& spot : spots) {
    EXPECT_LT(spot.radius_rad, 12 * kDegree);
    EXPECT_NEAR(spot.direction.y, 0.5, 0.05);
    light += spot.white.x;
  }
  EXPECT_THAT(bright_spots(strip, 1), IsEmpty()) << "one is too wide to be a spot";
  EXPECT_THAT(bright_spots(strip, 0), IsEmpty());
  // All but a few parts in a hundred of the excess is found.
  EXPECT_GT(light, 0.85 * irradiance(strip, {0, 0, 1}).x / kPi);
}

TEST(BrightSpots, EvenLightAndDarknessHaveNone) {
  EXPECT_THAT(bright_spots(lat_long(64, [](const Vec3&) { return Vec3{2, 1, 3}; })), IsEmpty());
  EXPECT_THAT(bright_spots(lat_long(64, [](const Vec3&) { return Vec3{}; })), IsEmpty());
  EXPECT_THAT(bright_spots(lat_long(64, [](const Vec3& d) { return (1.2 + d.y) * Vec3{1, 1, 1}; })), IsEmpty());
}

// A single texel that outshines the rest by the largest numbers that a float holds.
TEST(HardCase, ASpotOfOneTexelHasTheSizeOfTheTexel) {
  for (const double light : {1e4, 1e20, 1e30}) {
    const Environment environment = lat_long(256, [&](const Vec3& d) {
      return dot(d, normalized({0.3, 0.5, 0.8})) > std::cos(0.8 * kDegree) ? light * Vec3{1, 1, 1} : Vec3{1, 1, 1};
    });
    const std::vector<Spot> spots = bright_spots(environment);
    ASSERT_THAT(spots, SizeIs(1));
    EXPECT_GT(spots[0].radius_rad, 0.4 * kDegree);
    EXPECT_LT(spots[0].radius_rad, 2 * kDegree);
    EXPECT_TRUE(std::isfinite(spots[0].white.x));
    EXPECT_TRUE(spots_of_text(text_of_spots(spots)).ok());
  }
}

TEST(SunlitSky, SunAndSkyHaveTheLightOfTheEnvironment) {
  const Vec3 direction = normalized({0.5, 0.6, -0.4});
  const Environment whole = disc_on_sky(direction, 0.6 * kDegree, 2e4);
  const auto split = sunlit_sky(whole);
  ASSERT_TRUE(split.has_value());
  for (const Vec3& normal : {direction, Vec3{0, 1, 0}, normalized({-0.2, 0.3, -0.9})}) {
    const Vec3 all = irradiance(whole, normal), sky = irradiance(split->sky, normal);
    const double cosine = std::max(0.0, dot(normal, split->sun.direction));
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(sky[c] + kPi * cosine * split->sun.white[c], all[c], 1e-4 * all[c]);
    }
    if (cosine > 0) {
      EXPECT_LT(sky.x, 0.6 * all.x) << "the sun is taken out";
    }
  }
}

TEST(SunlitSky, IsNoneWithoutASunAboveTheHorizon) {
  const double sunny = 2e4;
  EXPECT_TRUE(sunlit_sky(disc_on_sky(normalized({0, 0.1, 1}), 0.6 * kDegree, sunny)).has_value());
  EXPECT_FALSE(sunlit_sky(disc_on_sky(normalized({0, -0.1, 1}), 0.6 * kDegree, sunny)).has_value()) << "from below";
  EXPECT_FALSE(sunlit_sky(disc_on_sky(normalized({0, 0.1, 1}), 8 * kDegree, 300)).has_value()) << "a window";
  EXPECT_FALSE(sunlit_sky(disc_on_sky(normalized({0, 0.1, 1}), 0.6 * kDegree, 100)).has_value()) << "too weak";
  EXPECT_FALSE(sunlit_sky(lat_long(64, [](const Vec3&) { return Vec3{}; })).has_value()) << "dark";
}

TEST(BrightSpots, AreTheSameFromAText) {
  const std::vector<Spot> spots = {{normalized({1, 2, 3}), {0.1, 1e-9, 7e5}, 0.0125}, {{0, 0, -1}, {0, 1, 0}, 1.2}};
  const auto read = spots_of_text(text_of_spots(spots));
  ASSERT_TRUE(read.ok());
  ASSERT_THAT(*read, SizeIs(2));
  EXPECT_EQ((*read)[1], spots[1]);
  EXPECT_NEAR(length((*read)[0].direction - spots[0].direction), 0, 1e-15);
  EXPECT_EQ((*read)[0].white, spots[0].white);
  EXPECT_THAT(*spots_of_text(""), IsEmpty());
}

TEST(BrightSpots, BadTextIsRefused) {
  const auto message = [](const std::string& text) {
    const auto read = spots_of_text(text);
    return read.ok() ? "" : read.error().message;
  };
  EXPECT_THAT(message("1 0 0 1 1 1"), HasSubstr("spot 1 has 6 numbers"));
  EXPECT_THAT(message("0 0 1 1 1 1 0.1;"), HasSubstr("spot 2 has 1 numbers"));
  EXPECT_THAT(message("0 0 1 1 1 x 0.1"), HasSubstr("\"x\""));
  EXPECT_THAT(message("0 0 1 1 1 nan 0.1"), HasSubstr("spot 1"));
  for (const char* text : {"0 0 2 1 1 1 0.1", "0 0 0 1 1 1 0.1", "0 0 1 -1 1 1 0.1", "0 0 1 1e300 1 1 0.1",
                           "0 0 1 1 1 1 0", "0 0 1 1 1 1 2"})
    EXPECT_THAT(message(text), HasSubstr("no direction of length 1")) << text;
  std::string many = "0 0 1 1 1 1 0.1";
  for (int i = 0; i < kMostSpots; ++i) many += ";0 0 1 1 1 1 0.1";
  EXPECT_THAT(message(many), HasSubstr("33 spots"));
}

}  // namespace
}  // namespace goniochrome::envmap::bright_spots_test
