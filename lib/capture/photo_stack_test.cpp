#include "capture/photo_stack.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/scratch_for_test.h"
#include "image/image.h"

namespace goniochrome::capture::photo_stack_test {
namespace {

class PhotoStackOf : public testing::Test {
 protected:
  void add(const std::string& name, int width, int height, const std::vector<float>& data) {
    const image::Image image{width, height, 3, data, {"R", "G", "B"}};
    image::ImagePart part{"", image, {{"colorInteropID", std::string("lin_rec2020_scene")}}, image::PixelType::kFloat};
    const std::string path = folder_.path(name);
    ASSERT_TRUE((name.ends_with(".png") ? image::write_png(path, image) : image::write_exr(path, {part})).ok());
    add_row(name);
  }
  void add_row(const std::string& name) {
    table_.path = "photos.csv";
    table_.photos.push_back({folder_.path(name), static_cast<int>(table_.photos.size()) + 2, {}, {}, 1});
  }
  std::string told() const {
    const auto stack = PhotoStack::open(table_, 1e9);
    return stack.ok() ? "nothing" : stack.error().message;
  }
  ScratchFolder folder_;
  PhotoTable table_;
};

TEST_F(PhotoStackOf, KeepsValuesRoundingAndSaturation) {
  add("a.exr", 2, 2, {0.1F, 0.2F, 0.3F, 0.4F, 0.5F, 0.6F, 0.7F, 0.8F, 0.9F, 2, 2, 2});
  add("b.png", 2, 2, {0, 0, 0, 0.5F, 0.5F, 0.5F, 1, 1, 1, 0.2F, 0.2F, 0.2F});
  const auto stack = PhotoStack::open(table_, 1.5);
  ASSERT_TRUE(stack.ok()) << stack.error().message;
  EXPECT_EQ(stack->count(), 2);
  std::vector<PhotoPixel> row;
  ASSERT_TRUE(stack->read_rows(1, 1, row).ok());
  ASSERT_EQ(row.size(), 4u);
  EXPECT_EQ(row[0].g, 0.8F);
  EXPECT_EQ(row[0].rounding, 0);
  EXPECT_LT(row[1].rounding, 0);  // saturated
  EXPECT_LT(row[2].rounding, 0);
  // 51 of 255 is 0.0331 of the light, where the curve has the slope 2.4/1.055 (0.255/1.055)^1.4.
  EXPECT_NEAR(row[3].g, 0.0331, 1e-4);
  EXPECT_NEAR(row[3].rounding * std::sqrt(12.0), 0.3116 / 255, 1e-6);
  EXPECT_EQ(stack->shares()[0].saturated, 0.25);
  EXPECT_EQ(stack->shares()[1].black, 0.25);
}

TEST_F(PhotoStackOf, RefusesWhatIsNoStack) {
  const std::vector<float> gray(12, 0.5F), white(12, 3.0F), black(12, 0.0F);
  add("a.exr", 2, 2, gray);
  add_row("absent.exr");
  EXPECT_NE(told().find("photos.csv:3: "), std::string::npos) << told();
  EXPECT_NE(told().find("absent.exr"), std::string::npos) << told();
  table_.photos.pop_back();
  add("b.exr", 4, 1, gray);
  EXPECT_NE(told().find("b.exr is 4 x 1"), std::string::npos) << told();
  table_.photos.clear();
  add("c.png", 2, 2, white);
  EXPECT_NE(told().find("100 % of all pixels are saturated: photograph with a shorter exposure"), std::string::npos);
  table_.photos.clear();
  add("d.exr", 2, 2, black);
  EXPECT_NE(told().find("100 % of all pixels are black: photograph with a longer exposure"), std::string::npos);
}

}  // namespace
}  // namespace goniochrome::capture::photo_stack_test
