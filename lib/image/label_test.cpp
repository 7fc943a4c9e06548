#include "image/label.h"

#include <gtest/gtest.h>

namespace goniochrome::image::label_test {
namespace {

int lit(const Image& image) {
  int count = 0;
  for (std::size_t i = 0; i < image.data.size(); i += 3) count += image.data[i] > 0;
  return count;
}

TEST(Label, DrawsLettersAndCutsThemOff) {
  Image image{20, 9, 3, std::vector<float>(20 * 9 * 3, 0.0F), {}};
  draw_label(image, 1, 1, "1", 1, {1, 1, 1});
  EXPECT_EQ(lit(image), 10) << "the digit one";
  EXPECT_EQ(image.pixel(3, 1)[0], 1) << "its top";
  EXPECT_EQ(image.pixel(1, 1)[0], 0);
  draw_label(image, -3, -3, "e", 2, {1, 1, 1});
  draw_label(image, 18, 7, "W", 3, {1, 1, 1});
  EXPECT_GT(lit(image), 10);
  EXPECT_EQ(label_width("ab", 2), 24);
  EXPECT_EQ(label_height(2), 14);
}

TEST(Label, SmallLettersAreCapitalsAndMissingOnesAreSeen) {
  Image small{8, 9, 3, std::vector<float>(8 * 9 * 3, 0.0F), {}}, capital = small, missing = small;
  draw_label(small, 1, 1, "k", 1, {1, 1, 1});
  draw_label(capital, 1, 1, "K", 1, {1, 1, 1});
  draw_label(missing, 1, 1, "\x01", 1, {1, 1, 1});
  EXPECT_EQ(small.data, capital.data);
  EXPECT_GT(lit(missing), lit(capital));
}

}  // namespace
}  // namespace goniochrome::image::label_test
