#include "image/shrink.h"

#include <gtest/gtest.h>

namespace goniochrome::image::shrink_test {
namespace {

TEST(Shrink, TakesTheMeanOfEachSquare) {
  Image picture{4, 2, 2, {}, {"A", "B"}};
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 4; ++x) picture.data.insert(picture.data.end(), {static_cast<float>(10 * y + x), 1});
  Image half{7, 7, 1, std::vector<float>(49, 9), {"C"}};  // of another picture
  shrink(picture, 2, half);
  EXPECT_EQ(half.width, 2);
  EXPECT_EQ(half.height, 1);
  EXPECT_EQ(half.channel_names, picture.channel_names);
  // (0 + 1 + 10 + 11)/4 and (2 + 3 + 12 + 13)/4
  EXPECT_EQ(half.data, (std::vector<float>{5.5, 1, 7.5, 1}));
}

TEST(Shrink, ByOneKeepsThePicture) {
  const Image picture{2, 1, 3, {1, 2, 3, 4, 5, 6}, {"R", "G", "B"}};
  Image same;
  shrink(picture, 1, same);
  EXPECT_EQ(same.data, picture.data);
}

TEST(Enlarged, IsLinearBetweenCentersAndEvenBeyondThem) {
  const Image picture{2, 2, 1, {0, 4, 8, 12}, {"A"}};
  const Image large = enlarged(picture, 4, 2);
  EXPECT_EQ(large.channel_names, picture.channel_names);
  EXPECT_EQ(large.data, (std::vector<float>{0, 1, 3, 4, 8, 9, 11, 12}));
  EXPECT_EQ(enlarged(picture, 2, 2).data, picture.data);
  EXPECT_EQ(enlarged(picture, 1, 1).data, (std::vector<float>{6}));
}

}  // namespace
}  // namespace goniochrome::image::shrink_test
