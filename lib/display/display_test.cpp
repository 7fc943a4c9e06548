#include "display/display.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "base/random_for_test.h"

namespace goniochrome::display {
namespace {

using testing::HasSubstr;

image::Image one_pixel(const color::Rgb& c) {
  return {1, 1, 4, {static_cast<float>(c.x), static_cast<float>(c.y), static_cast<float>(c.z), 1}, {}};
}

color::Rgb shown(const std::string& view, const color::Rgb& working, double stops = 0) {
  const auto display = Display::make(view);
  EXPECT_TRUE(display.ok()) << display.error().message;
  const auto image = display->image(one_pixel(working), stops);
  EXPECT_TRUE(image.ok());
  return {image->data[0], image->data[1], image->data[2]};
}

double srgb(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

TEST(PaintView, KeepsColorsBelowTheKneeAndHueAboveIt) {
  TestNumbers random(3);
  int above = 0;
  for (int trial = 0; trial < 10000; ++trial) {
    const double gain = std::exp2(12 * random() - 6);
    const color::Rgb c = gain * color::Rgb{random(), random(), random()};
    const color::Rgb v = paint_view(c);
    const double most = std::max({c.x, c.y, c.z});
    if (most <= kKnee) {
      EXPECT_EQ(v, c);
      continue;
    }
    ++above;
    EXPECT_LT(std::max({v.x, v.y, v.z}), 1);
    EXPECT_LT(length(cross(v, c)), 1e-12 * length(v) * length(c)) << "same ratios, same hue";
  }
  EXPECT_GT(above, 1000);
  // The control, a display that clips each channel, turns a bright orange yellow.
  const color::Rgb orange{4, 2, 0.2}, clipped{1, 1, 0.2};
  EXPECT_GT(length(cross(clipped, orange)), 0.1 * length(clipped) * length(orange));
}

TEST(PaintView, IsMonotoneAndSmoothAtTheKnee) {
  double last = 0;
  for (double x = 0.7; x < 20; x += 0.01) {
    const double now = paint_view({x, 0, 0}).x;
    EXPECT_GT(now, last);
    EXPECT_LT(now - last, x > 0.7 ? 0.0101 : 1);
    last = now;
  }
}

TEST(PaintView, OutOfGamutKeepsItsLuminance) {
  const auto luminance = [](const color::Rgb& c) { return color::xyz_d65_from_rgb(color::rec2020_from_rec709(c)).Y; };
  for (const color::Rgb& c : {color::Rgb{0.4, -0.1, 0.2}, color::Rgb{-0.05, 0.3, 0.1}, color::Rgb{0.02, 0.01, -0.2}}) {
    const color::Rgb v = paint_view(c);
    EXPECT_GE(std::min({v.x, v.y, v.z}), -1e-15);
    EXPECT_NEAR(luminance(v), std::max(0.0, luminance(c)), 1e-12);
  }
}

TEST(Display, BuiltInViews) {
  unsetenv("OCIO");
  for (const char* view : {"", "Paint", "paint", "Un-tone-mapped", "sRGB/Un-tone-mapped"}) {
    const color::Rgb gray = shown(view, {0.18, 0.18, 0.18});
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(gray[c], srgb(0.18), 2e-4) << view;
    const color::Rgb red = shown(view, color::rec2020_from_rec709({0.5, 0.02, 0.1}));
    EXPECT_NEAR(red.x, srgb(0.5), 2e-4) << view;
    EXPECT_NEAR(red.y, srgb(0.02), 1e-3) << view;
    EXPECT_NEAR(red.z, srgb(0.1), 5e-4) << view;
  }
  EXPECT_NEAR(shown("Un-tone-mapped", {0.5, 0.5, 0.5}, 1).y, 1, 1e-4) << "exposure";
  EXPECT_EQ(shown("Un-tone-mapped", {9, 9, 9}).y, 1);
  EXPECT_LT(shown("Paint", {9, 9, 9}).y, 1);
  const color::Rgb aces = shown("ACES SDR", {0.18, 0.18, 0.18});
  EXPECT_GT(aces.x, 0.3);
  EXPECT_LT(aces.x, 0.45) << "ACES shows middle gray at 10 % of display white";
  EXPECT_THAT(Display::make("filmic").error().message,
              HasSubstr("no view \"filmic\": there are \"Paint\", \"Un-tone-mapped\", \"ACES SDR\""));
}

TEST(Display, ForeignConfigurationIsHonoredOrRefusedByName) {
  setenv("OCIO", "/nowhere/config.ocio", 1);
  const auto refused = Display::make("");
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().message, HasSubstr("/nowhere/config.ocio"));
  EXPECT_THAT(refused.error().message, HasSubstr("unset it"));
  unsetenv("OCIO");
}

}  // namespace
}  // namespace goniochrome::display
