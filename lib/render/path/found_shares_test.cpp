#include "render/path/found_shares.h"

#include <gtest/gtest.h>

namespace goniochrome::render::found_shares_test {
namespace {

// Points before a gray base, whose shares change the lightness by known amounts; the noise has the mean 0.
std::vector<SharedPoint> points_with(const LightShares& shares, double noise) {
  std::vector<SharedPoint> points;
  for (int i = 0; i < 1000; ++i) {
    SharedPoint point{shares, {0.2, 0.2, 0.2}};
    const double off = i % 2 == 0 ? noise : -noise;
    point.shares.into_diffuse += off * color::Rgb{1, 1, 1};
    points.push_back(point);
  }
  return points;
}

TEST(FoundShares, TellWhatEachChangesAndStopWhatIsUnseen) {
  const LightShares shares{{-0.05, -0.05, -0.05}, {0.01, 0.01, 0.01}, {1e-4, 1e-4, 1e-4}};
  const auto smooth = points_with(shares, 0);
  const FoundShares found = found_shares(smooth, smooth, 0.2, 1);
  EXPECT_GT(found.of[0].de00_p95, 3);
  EXPECT_GT(found.of[1].de00_p95, 0.5);
  EXPECT_GT(found.of[2].de00_p95, 0);
  EXPECT_LT(found.of[2].de00_p95, 0.05);
  EXPECT_EQ(found.of[3].de00_p95, 0);
  EXPECT_EQ(found.stopped, 0b1100U);
  EXPECT_EQ(found.stopped_de00, found.of[2].de00_p95);
  // A share that changes little in the mean, but is noisy, goes on: its pixels could not stay as they are.
  const FoundShares noisy = found_shares(points_with(shares, 0.02), smooth, 0.2, 1);
  EXPECT_EQ(noisy.stopped, 0b1000U);
  EXPECT_EQ(noisy.of[2].de00_p95, found.of[2].de00_p95);
}

// Two shares of which each would be unseen alone are seen together.
TEST(FoundShares, StopTogetherOnlyWhatIsUnseenTogether) {
  const color::Rgb little{0.002, 0.002, 0.002};
  const auto points = points_with({{-0.05, -0.05, -0.05}, little, little}, 0);
  const double alone = found_shares(points, points, 0, 1).of[1].de00_p95;
  EXPECT_EQ(found_shares(points, points, 1.5 * alone, 1).stopped, 0b1010U);
  EXPECT_EQ(found_shares(points, points, 2.5 * alone, 1).stopped, 0b1110U);
}

}  // namespace
}  // namespace goniochrome::render::found_shares_test
