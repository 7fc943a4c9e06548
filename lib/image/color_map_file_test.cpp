#include "image/color_map_file.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace goniochrome::image {
namespace {

TEST(ColorMapFile, RoundTrip) {
  const std::string path = testing::TempDir() + "map.exr";
  brdf::ColorMap map = brdf::color_map_of_size(4, 1.45);
  for (std::size_t i = 0; i < map.factors.size(); ++i) map.factors[i] = 0.25f * static_cast<float>(i) - 1;
  ASSERT_TRUE(write_color_map(path, map, {{"made", std::string("here")}}).ok());
  const auto back = read_color_map(path);
  ASSERT_TRUE(back.ok()) << back.error().message;
  EXPECT_EQ(back->size, 4);
  EXPECT_DOUBLE_EQ(back->index, 1.45);
  EXPECT_EQ(back->factors, map.factors);  // quarters are exact in half precision
  std::filesystem::remove(path);
}

TEST(ColorMapFile, RefusesWhatIsNoMap) {
  const std::string path = testing::TempDir() + "no-map.exr";
  ASSERT_TRUE(write_exr(path, {{"", {4, 4, 3, std::vector<float>(48, 0.5f), {}}, {}, PixelType::kHalf}}).ok());
  const auto square = read_color_map(path);
  ASSERT_FALSE(square.ok());
  EXPECT_NE(square.error().message.find("twice as high as wide"), std::string::npos);
  const std::vector<float> values(24, 0.5f);
  ASSERT_TRUE(write_exr(path, {{"", {2, 4, 3, values, {}}, {{"goniochrome:index", 0.5f}}, PixelType::kHalf}}).ok());
  EXPECT_NE(read_color_map(path).error().message.find("from 1 to 4"), std::string::npos);
  ASSERT_TRUE(write_exr(path, {{"", {2, 4, 3, values, {}}, {}, PixelType::kHalf}}).ok());
  EXPECT_DOUBLE_EQ(read_color_map(path)->index, 1.5);
  std::filesystem::remove(path);
  EXPECT_FALSE(read_color_map(path).ok());
}

}  // namespace
}  // namespace goniochrome::image
