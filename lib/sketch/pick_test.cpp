#include "sketch/pick.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sketch/sketch_picture.h"

namespace goniochrome::sketch::pick_test {
namespace {

using testing::HasSubstr;

// A scene-linear image in the working space, so that a dropper must find the colors put in.
image::ImagePart flat(int width, int height, const color::Rgb& color) {
  image::ImagePart part;
  part.image = {width, height, 3, {}, {"R", "G", "B"}};
  for (int i = 0; i < width * height; ++i)
    for (int c = 0; c < 3; ++c) part.image.data.push_back(static_cast<float>(color[c]));
  part.attributes["colorInteropID"] = std::string("lin_rec2020_scene");
  return part;
}

color::Lab lab_of(const color::Rgb& rgb) {
  return color::lab_from_rgb(rgb, *color::white_point({}));
}

TEST(Pick, FloatsThatStateNothingAreOfRec709) {
  image::ImagePart red = flat(1, 1, {1, 0, 0});
  red.attributes.clear();
  const auto picture = picture_of(std::move(red), "a.exr", PictureView::kShown);
  ASSERT_TRUE(picture.ok()) << picture.error().message;
  EXPECT_NEAR(picture->pixel(0, 0)[0], 0.6274, 1e-3);
  EXPECT_NEAR(picture->pixel(0, 0)[1], 0.0691, 1e-3);
}

TEST(Pick, DroppersAreReadWholeOrRefused) {
  const auto d = parse_dropper("a@b/c.png@12,7,2.5", "--face");
  ASSERT_TRUE(d.ok());
  EXPECT_EQ(d->image, "a@b/c.png");
  EXPECT_EQ(d->x, 12);
  EXPECT_EQ(d->y, 7);
  EXPECT_EQ(d->radius, 2.5);
  EXPECT_EQ(parse_dropper("c.png@1,2", "--face")->radius, kPickRadius);
  for (const char* text : {"c.png", "@1,2", "c.png@", "c.png@1", "c.png@1,2,3,4", "c.png@1.5,2", "c.png@-1,2",
                           "c.png@1,2,-1", "c.png@1,2,nan", "c.png@99999999999,2"}) {
    const auto bad = parse_dropper(text, "--face");
    ASSERT_FALSE(bad.ok()) << text;
    EXPECT_THAT(bad.error().message, HasSubstr("--face is \"" + std::string(text) + "\": write IMAGE@X,Y"));
  }
}

// Half of the disc at each of two lights: the mean of the lights. The control is the mean of the Lab values.
TEST(Pick, ColorsAreAveragedInLight) {
  image::ImagePart image = flat(40, 40, {0.9, 0.9, 0.9});
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 40; ++x)
      for (int c = 0; c < 3; ++c) image.image.pixel(x, y)[c] = 0.01F;
  for (int x = 0; x < 40; ++x)
    for (int c = 0; c < 3; ++c) image.image.pixel(x, 20)[c] = 0.455F;  // the middle row has the mean
  const auto sample = pick(image, "a", {"a", 20, 20, 6});
  ASSERT_TRUE(sample.ok());
  EXPECT_NEAR(sample->lab.L, lab_of({0.455, 0.455, 0.455}).L, 0.01);
  const double mean_L = 0.5 * (lab_of({0.9, 0.9, 0.9}).L + lab_of({0.01, 0.01, 0.01}).L);
  EXPECT_GT(std::abs(sample->lab.L - mean_L), 10);
}

TEST(Pick, ADiscAtTheBorderIsCutAndAPointOutsideIsRefused) {
  const image::ImagePart image = flat(10, 8, {0.2, 0.3, 0.4});
  const auto corner = pick(image, "a", {"a", 0, 0, 3}), single = pick(image, "a", {"a", 9, 7, 0});
  ASSERT_TRUE(corner.ok() && single.ok());
  EXPECT_EQ(corner->pixels, 11);  // x^2 + y^2 <= 9 in a quadrant with its axes
  EXPECT_EQ(single->pixels, 1);
  EXPECT_NEAR(color::delta_e_76(corner->lab, lab_of({0.2, 0.3, 0.4})), 0, 1e-4);
  EXPECT_NEAR(color::delta_e_76(single->lab, corner->lab), 0, 1e-4);
  const auto outside = pick(image, "a.exr", {"a", 10, 0, 3});
  ASSERT_FALSE(outside.ok());
  EXPECT_THAT(outside.error().message, HasSubstr("a.exr: the point 10,0 lies outside its 10 x 8 pixels"));
}

TEST(Pick, OneColorMakesASolidAndTwoTradePlaces) {
  const color::Lab light{80, 1, 2}, dark{20, 3, 4};
  PaintPick wanted;
  wanted.name = "x";
  EXPECT_EQ(picked_paint(wanted, dark, {}, {}).paint.paint_class, paint::PaintClass::kSolid);
  EXPECT_EQ(picked_paint(wanted, {}, dark, 30.0).paint.gloss.front().gloss_units, 30);
  EXPECT_FALSE(picked_paint(wanted, light, dark, {}).swapped);
  const PickedPaint swapped = picked_paint(wanted, dark, light, {});
  EXPECT_TRUE(swapped.swapped);
  EXPECT_EQ(swapped.paint.appearance->face, light);
  wanted.retro = true;
  EXPECT_EQ(picked_paint(wanted, dark, light, {}).paint.appearance->face, dark);
}

TEST(Pick, APalettePairsTheLightAndTheDarkOfEachColor) {
  image::ImagePart image = flat(90, 60, {0, 0, 0});
  const auto shade = [&](int x, int y) {
    const double s = 0.2 + 0.8 * y / 59.0;
    return x < 60 ? color::Rgb{0.6 * s, 0.1 * s, 0.1 * s} : color::Rgb{0.1 * s, 0.15 * s, 0.6 * s};
  };
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 90; ++x)
      for (int c = 0; c < 3; ++c) image.image.pixel(x, y)[c] = static_cast<float>(shade(x, y)[c]);
  const auto pairs = palette(image, "a", 2);
  ASSERT_TRUE(pairs.ok());
  ASSERT_EQ(pairs->size(), 2U);
  EXPECT_NEAR(pairs->front().share, 2.0 / 3, 0.02);
  // From 83 to 98 % and up to 15 % of the rows: s about 0.92 and 0.26.
  EXPECT_LE(color::delta_e_76(pairs->front().face, lab_of(shade(0, 54))), 1);
  EXPECT_LE(color::delta_e_76(pairs->front().flop, lab_of(shade(0, 4))), 1);
  EXPECT_LE(color::delta_e_76(pairs->back().face, lab_of(shade(80, 54))), 1);
  EXPECT_EQ(palette(flat(30, 30, {0.1, 0.2, 0.3}), "a", 8)->size(), 1U);
}

}  // namespace
}  // namespace goniochrome::sketch::pick_test
