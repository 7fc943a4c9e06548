#include "display/paint_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/random_for_test.h"

namespace goniochrome::display::paint_view_test {
namespace {

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

TEST(PaintView, KeepsTheLuminanceOfColorsOutOfGamut) {
  const auto luminance = [](const color::Rgb& c) { return color::xyz_d65_from_rgb(color::rec2020_from_rec709(c)).Y; };
  for (const color::Rgb& c : {color::Rgb{0.4, -0.1, 0.2}, color::Rgb{-0.05, 0.3, 0.1}, color::Rgb{0.02, 0.01, -0.2}}) {
    const color::Rgb v = paint_view(c);
    EXPECT_GE(std::min({v.x, v.y, v.z}), -1e-15);
    EXPECT_NEAR(luminance(v), std::max(0.0, luminance(c)), 1e-12);
  }
}

// Rounding grows by the slope of the inverse, (1 + x)^2, which is 729 at the largest light here, 6 times the white. The
// control, which leaves the shoulder as it is, is off by more than half of that light.
TEST(PaintView, UndoneGivesTheLightBack) {
  TestNumbers random(5);
  double control = 0;
  for (int trial = 0; trial < 10000; ++trial) {
    const double gain = 6 * random();
    const color::Rgb light = gain * color::Rgb{random(), random(), random()};
    const color::Rgb shown = paint_view(light), back = paint_view_undone(shown);
    EXPECT_LT(length(back - light), 1e-12);
    EXPECT_LT(length(paint_view(back) - shown), 1e-14);
    control = std::max(control, length(shown - light));
  }
  EXPECT_GT(control, 3);
}

// The view's definition: a line to 0.8, then k + (1-k) x/(1+x).
TEST(PaintView, UndoneFollowsItsDefinition) {
  for (const double m : {0.0, 0.3, 0.8, 0.85, 1.0, 2.0, 5.0}) {
    const color::Rgb light{m, 0.5 * m, 0.2 * m};
    const double x = (m - 0.8) / 0.2, shown = m <= 0.8 ? m : 0.8 + 0.2 * x / (1 + x);
    const color::Rgb back = paint_view_undone((m > 0 ? shown / m : 1) * light);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(back[c], light[c], 1e-12 + 1e-12 * m);
  }
}

// Linear .5, .02, .02 of Display P3, whose sRGB signals are .735357 and .151704, and which has no Rec.709 green.
TEST(DisplayGamut, OfDisplayP3IsWider) {
  const color::Rgb red{0.38184, 0.041957, 0.019419};
  const color::Rgb light = screen_light(red, Screen::kDisplayP3);
  EXPECT_NEAR(light.x, 0.5, 1e-5);
  EXPECT_NEAR(light.y, 0.02, 1e-5);
  EXPECT_NEAR(light.z, 0.02, 1e-5);
  EXPECT_EQ(in_display_gamut(red, Screen::kDisplayP3), red);
  EXPECT_NE(in_display_gamut(red), red);
  const color::Xyz white{0.9504, 1, 1.0888};
  const color::Lab lab = color::lab_from_rgb(red, white);
  EXPECT_EQ(screen_color(lab, white, Screen::kDisplayP3), (std::array<int, 3>{188, 39, 39}));
  const double hue_deg = color::hue_deg(lab);
  EXPECT_LT(screen_chroma(lab.L, hue_deg, white), color::chroma(lab));
  EXPECT_GT(screen_chroma(lab.L, hue_deg, white, Screen::kDisplayP3), color::chroma(lab));
}

TEST(DisplayGamut, KeepsLuminanceAndWhatIsInside) {
  const color::Rgb inside{0.3, 0.2, 0.1}, outside{0, 0.5, 0};
  EXPECT_EQ(in_display_gamut(inside), inside);
  const color::Rgb kept = in_display_gamut(outside);
  EXPECT_NEAR(color::xyz_d65_from_rgb(kept).Y, color::xyz_d65_from_rgb(outside).Y, 1e-12);
  const color::Rgb shown = color::rec709_from_rec2020(kept);
  EXPECT_NEAR(std::min({shown.x, shown.y, shown.z}), 0, 1e-12);
}

TEST(SrgbSignal, IsThatOfTheStandard) {
  EXPECT_EQ(srgb_signal(-1), 0);
  EXPECT_NEAR(srgb_signal(7), 1, 1e-15);
  EXPECT_NEAR(srgb_signal(0.2140411), 0.5, 1e-6);  // IEC 61966-2-1
}

// Five codes up or down never cross more light than the bound says.
TEST(CodeWidth, HoldsFiveCodesOfTheDisplay) {
  for (double light = 0; light < 4; light += 0.01) {
    const double signal = srgb_signal(paint_view({light, 0, 0}).x), more = signal + 5.0 / 255;
    if (more >= 1) break;
    const double linear = more <= 0.04045 ? more / 12.92 : std::pow((more + 0.055) / 1.055, 2.4);
    const double above = paint_view_undone({linear, 0, 0}).x;
    EXPECT_LE(above - light, code_width(above, above)) << light;
  }
}

}  // namespace
}  // namespace goniochrome::display::paint_view_test
