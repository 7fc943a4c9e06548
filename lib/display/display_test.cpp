#include "display/display.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>

#include "base/scratch_for_test.h"
#include "display/paint_view.h"

namespace goniochrome::display::display_test {
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

TEST(Display, BuiltInViewsShowTheirSignalsAndOthersAreRefused) {
  unsetenv("OCIO");
  for (const char* view : {"", "Paint", "paint", "Un-tone-mapped", "sRGB/Un-tone-mapped"}) {
    const color::Rgb gray = shown(view, {0.18, 0.18, 0.18});
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(gray[c], srgb_signal(0.18), 2e-4) << view;
    const color::Rgb red = shown(view, color::rec2020_from_rec709({0.5, 0.02, 0.1}));
    EXPECT_NEAR(red.x, srgb_signal(0.5), 2e-4) << view;
    EXPECT_NEAR(red.y, srgb_signal(0.02), 1e-3) << view;
    EXPECT_NEAR(red.z, srgb_signal(0.1), 5e-4) << view;
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

// Light that a view shows in gamut comes back. The control takes the signals for those of Paint.
TEST(Display, UndoBringsBackTheLightOfEveryBuiltInView) {
  unsetenv("OCIO");
  for (const char* view : {"Paint", "sRGB / Paint", "Un-tone-mapped", "sRGB / ACES SDR"}) {
    const auto display = Display::make(view);
    ASSERT_TRUE(display.ok()) << display.error().message;
    double control = 0;
    for (const color::Rgb& rec709 :
         {color::Rgb{0.18, 0.18, 0.18}, {0.5, 0.1, 0.05}, {0.05, 0.3, 0.6}, {0.02, 0.02, 0.01}}) {
      const color::Rgb light = color::rec2020_from_rec709(rec709);
      auto signals = display->image(one_pixel(light), 0);
      ASSERT_TRUE(signals.ok());
      image::Image as_paint = *signals;
      ASSERT_TRUE(display->undo(*signals).ok());
      ASSERT_TRUE(Display::make("Paint")->undo(as_paint).ok());
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(signals->data[static_cast<std::size_t>(c)], light[c], 0.01 * light[c] + 1e-3) << view;
        control = std::max(control, std::abs(as_paint.data[static_cast<std::size_t>(c)] / light[c] - 1));
      }
    }
    EXPECT_EQ(control > 0.2, std::string(view) == "sRGB / ACES SDR") << view;
  }
}

// Every code, half a code on both sides of each end, and what lies outside of 0..1.
TEST(Display, BytesOfThePaintViewAreTheNearestCodes) {
  unsetenv("OCIO");
  const auto display = Display::make("");
  ASSERT_TRUE(display.ok());
  std::vector<double> lights = {-1, 0, 1e-9, 0.0031307, 0.0031309};
  for (int i = 0; i < 3000; ++i) lights.push_back(0.8 * i / 3000);  // up to the knee light is shown as it is
  image::Image picture{static_cast<int>(lights.size()), 1, 4, {}, {}};
  for (const double light : lights)
    picture.data.insert(picture.data.end(),
                        {static_cast<float>(light), static_cast<float>(light), static_cast<float>(light), 1.0F});
  image::ByteImage shown;
  ASSERT_TRUE(display->show(picture, 0, shown).ok());
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const double light = picture.data[4 * i];
    const double code = 255 * srgb_signal(color::rec709_from_rec2020({light, light, light}).x);
    EXPECT_LE(std::abs(shown.rgb[3 * i] - code), 0.5 + 1e-9) << lights[i];
  }
  // Other views go through OpenColorIO, and agree where light is shown as it is.
  image::ByteImage plain;
  ASSERT_TRUE(Display::make("Un-tone-mapped")->show(picture, 0, plain).ok());
  for (std::size_t i = 0; i < shown.rgb.size(); ++i) EXPECT_LE(std::abs(shown.rgb[i] - plain.rgb[i]), 1);
}

TEST(Display, APixelThatIsNotFiniteIsRefused) {
  unsetenv("OCIO");
  image::Image picture = one_pixel({0.5, 0.5, 0.5});
  picture.data[1] = std::numeric_limits<float>::quiet_NaN();
  image::ByteImage shown;
  for (const char* view : {"Paint", "Un-tone-mapped"})
    EXPECT_THAT(Display::make(view)->show(picture, 0, shown).error().message,
                HasSubstr("the picture: pixel 0,0 channel G is nan"));
}

TEST(Display, NamesTheSignalsOfItsDisplay) {
  const ScratchFolder folder;
  const auto signal_in = [&](const char* space) {
    const std::string config = fmt::format(
        "ocio_profile_version: 2\nsearch_path: luts\nroles:\n  aces_interchange: ap0\n  default: ap0\n"
        "file_rules:\n  - !<Rule> {{name: Default, colorspace: default}}\n"
        "displays:\n  Screen:\n    - !<View> {{name: Shown, colorspace: {0}}}\n"
        "colorspaces:\n  - !<ColorSpace>\n    name: ap0\n  - !<ColorSpace>\n    name: {0}\n",
        space);
    setenv("OCIO", folder.file("config.ocio", config).c_str(), 1);
    const auto display = Display::make("");
    EXPECT_TRUE(display.ok()) << display.error().message;
    image::ByteImage shown;
    EXPECT_TRUE(display->show(one_pixel({0.5, 0.5, 0.5}), 0, shown).ok());
    unsetenv("OCIO");
    return shown.signal;
  };
  EXPECT_EQ(signal_in("sRGB - Display"), (image::SignalCode{1, 13}));
  EXPECT_EQ(signal_in("Display P3 - Display"), (image::SignalCode{12, 13}));
  EXPECT_EQ(signal_in("Rec.2100-PQ - Display"), (image::SignalCode{9, 16}));
  EXPECT_EQ(signal_in("Rec.1886 Rec.709 - Display"), (image::SignalCode{1, 1}));
  EXPECT_EQ(signal_in("P3-DCI - Display"), std::nullopt) << "its gamma of 2.6 has no code";
}

TEST(Display, ABadConfigurationIsRefusedByName) {
  setenv("OCIO", "/nowhere/config.ocio", 1);
  const auto refused = Display::make("");
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().message, HasSubstr("/nowhere/config.ocio"));
  EXPECT_THAT(refused.error().message, HasSubstr("unset it"));
  unsetenv("OCIO");
}

}  // namespace
}  // namespace goniochrome::display::display_test
