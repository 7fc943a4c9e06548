// The pixels by which the effects of rays are judged.
#include "render/plan/spread_pixels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <ranges>
#include <set>
#include <tuple>

namespace goniochrome::render::spread_pixels_test {
namespace {

std::shared_ptr<const Gbuffer> picture(int width, int height, const std::function<bool(int, int)>& seen) {
  auto gbuffer = std::make_shared<Gbuffer>();
  gbuffer->width = width, gbuffer->height = height;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) gbuffer->data.insert(gbuffer->data.end(), {0, 1, 0, seen(x, y) ? 1.0F : 0.0F});
  return gbuffer;
}

TEST(SpreadPixels, ShowTheMeshAndAreDifferent) {
  const auto disc = picture(200, 90, [](int x, int y) { return std::hypot(x - 100, y - 45) < 40; });
  const auto part = picture(33, 17, [](int x, int) { return x > 20; });
  const auto visible = static_cast<std::size_t>(std::ranges::count_if(
      std::views::iota(0, 200 * 90), [&](int i) { return disc->data[4 * static_cast<std::size_t>(i) + 3] != 0; }));
  const std::size_t all = visible + 12 * 17;
  for (const std::size_t count : {std::size_t{1}, std::size_t{500}, all, all + 1000}) {
    const std::vector<ProbePixel> pixels = spread_pixels({disc, part}, count);
    EXPECT_EQ(pixels.size(), std::min(count, all));
    std::set<std::tuple<const Gbuffer*, int, int>> different;
    for (const auto& [gbuffer, x, y] : pixels) {
      EXPECT_NE(gbuffer->at(x, y)[3], 0);
      different.insert({gbuffer, x, y});
    }
    EXPECT_EQ(different.size(), pixels.size());
  }
  EXPECT_TRUE(spread_pixels({picture(8, 8, [](int, int) { return false; })}, 10).empty());
  EXPECT_TRUE(spread_pixels({}, 10).empty());
}

// Stripes of any width and direction are met as often as they are wide: the share of 1000 points that a random choice
// finds in a third scatters by .015, and that of this choice by less. Control: every n-th pixel, row by row, which
// meets the same columns.
TEST(SpreadPixels, AreSpreadOverWhatRepeats) {
  constexpr int kWidth = 300, kHeight = 300;
  constexpr std::size_t kCount = 1000;
  const auto whole = picture(kWidth, kHeight, [](int, int) { return true; });
  const std::vector<ProbePixel> pixels = spread_pixels({whole}, kCount);
  double worst = 0, worst_control = 0;
  for (const int period : {3, 12, 60, 150}) {
    for (const bool upright : {false, true}) {
      const auto met = [&](int x, int y) { return (upright ? x : y) % period < period / 3; };
      double share = 0, control = 0;
      for (const auto& [gbuffer, x, y] : pixels) share += met(x, y) / static_cast<double>(kCount);
      for (int i = 30; i < kWidth * kHeight; i += kWidth * kHeight / kCount)
        control += met(i % kWidth, i / kWidth) / static_cast<double>(kCount);
      worst = std::max(worst, std::abs(share - 1.0 / 3));
      worst_control = std::max(worst_control, std::abs(control - 1.0 / 3));
    }
  }
  EXPECT_LT(worst, 3 * 0.015);
  EXPECT_GT(worst_control, 0.2);
}

// Those near each other in the list are near in the picture: four places on in the list, the points of a picture where
// they are 4 pixels apart are less than 4 x 4 pixels away, which they would be row by row.
TEST(SpreadPixels, FollowThePicture) {
  const auto whole = picture(256, 256, [](int, int) { return true; });
  const std::vector<ProbePixel> pixels = spread_pixels({whole}, 4096);
  double sum = 0;
  for (std::size_t i = 0; i + 4 < pixels.size(); ++i)
    sum += std::hypot(pixels[i + 4].x - pixels[i].x, pixels[i + 4].y - pixels[i].y);
  EXPECT_LT(sum / static_cast<double>(pixels.size()), 14);
}

}  // namespace
}  // namespace goniochrome::render::spread_pixels_test
