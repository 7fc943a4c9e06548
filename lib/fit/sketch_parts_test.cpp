// The pieces of sketch fitting: gloss from pictures, views, solvers.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "brdf/gloss.h"
#include "brdf/lobe_model.h"
#include "fit/sketch_common.h"
#include "fit/sketch_gloss.h"
#include "fit/sketch_picture.h"
#include "fit/sketch_solve.h"

namespace goniochrome {
namespace {

TEST(SketchGloss, gloss_limits_contrast_maps_to_0_and_100) {
  std::vector<double> flat(50, 0.4), half, full;
  for (int i = 0; i < 100; ++i) half.push_back(i < 50 ? 0.25 : 0.5), full.push_back(i < 50 ? 0.1 : 0.9);
  EXPECT_EQ(contrast_gloss(flat), 0);
  EXPECT_NEAR(contrast_gloss(half), 50, 1e-12);
  EXPECT_EQ(contrast_gloss(full), 100);  // the control, without its cap, is 160
  std::vector<double> one = {0.3}, none;
  EXPECT_EQ(contrast_gloss(one), 0);
  EXPECT_EQ(contrast_gloss(none), 0);
}

TEST(SketchGloss, display_brightness_is_the_srgb_signal) {
  EXPECT_EQ(display_brightness(-1), 0);
  EXPECT_NEAR(display_brightness(7), 1, 1e-15);
  EXPECT_NEAR(display_brightness(0.2140411), 0.5, 1e-6);  // IEC 61966-2-1
}

// A highlight of one lobe reads what the simulated meter reads on that lobe; its own exponent lies between two of the
// fit's, whose mixture differs by some percent.
TEST(SketchGloss, a_highlight_reads_like_its_lobe) {
  for (const double exponent : {90.0, 400.0, 1500.0}) {
    const double weight = 0.04 * (exponent + 1) / (2 * std::numbers::pi);
    std::vector<HighlightSample> samples;
    for (double t = 0.1; t < 15; t += 0.05)
      samples.push_back({t, std::numbers::pi * weight * cos_power(t * std::numbers::pi / 180, exponent)});
    const GlossTable table({exponent});
    LobeFit lobe;
    lobe.lobes.push_back({exponent, {}, {weight, weight, weight}});
    const double meter = gloss_units(table, **table.at(60), lobe);
    const auto found = highlight_gloss(samples);
    ASSERT_TRUE(found);
    EXPECT_NEAR(*found, meter, 0.1 * meter) << exponent;
  }
}

TEST(SketchGloss, gloss_limits_no_highlight_is_no_reading) {
  std::vector<HighlightSample> dark, far;
  for (double t = 0; t < 15; t += 0.1) dark.push_back({t, 0}), far.push_back({t + 3, 1});
  EXPECT_FALSE(highlight_gloss(dark));
  EXPECT_FALSE(highlight_gloss(far));
  EXPECT_FALSE(highlight_gloss({}));
}

// The view's definition: a line to 0.8, then k + (1-k) x/(1+x).
TEST(SketchPicture, the_view_paint_is_undone) {
  for (const double m : {0.0, 0.3, 0.8, 0.85, 1.0, 2.0, 5.0}) {
    const Rgb light{m, 0.5 * m, 0.2 * m};
    const double x = (m - 0.8) / 0.2, shown = m <= 0.8 ? m : 0.8 + 0.2 * x / (1 + x);
    const Rgb back = paint_view_undone((m > 0 ? shown / m : 1) * light);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(back[c], light[c], 1e-12 + 1e-12 * m);
  }
}

TEST(SketchPicture, the_display_gamut_keeps_luminance_and_what_is_inside) {
  const Rgb inside{0.3, 0.2, 0.1}, outside{0, 0.5, 0};
  EXPECT_EQ(in_display_gamut(inside), inside);
  const Rgb kept = in_display_gamut(outside);
  EXPECT_NEAR(xyz_d65_from_rgb(kept).Y, xyz_d65_from_rgb(outside).Y, 1e-12);
  const Rgb shown = rec709_from_rec2020(kept);
  EXPECT_NEAR(std::min({shown.x, shown.y, shown.z}), 0, 1e-12);
}

TEST(SketchSolve, normal_equations_find_non_negative_weights) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  NormalEquations normal(4);
  const double truth[4] = {0.5, 0, 2, 0};
  for (int i = 0; i < 50; ++i) {
    double row[4] = {unit(random), unit(random), unit(random), 0};  // the last column is seen by no row
    normal.add(row, truth[0] * row[0] + truth[2] * row[2] - 1e-9 * row[1], 1 + unit(random));
  }
  const std::vector<double> x = normal.non_negative();
  for (int k = 0; k < 4; ++k) EXPECT_NEAR(x[k], truth[k], 1e-7);
  for (const double value : x) EXPECT_GE(value, 0);
}

TEST(SketchSolve, the_search_puts_outliers_aside_and_stays_in_its_domain) {
  // y = a x + b in every channel, a third of the points about 90 off, each of which still pulls with some thousandths
  // of its weight. The control, plain least squares, has the intercept above 30.
  std::vector<double> xs, ys;
  for (int i = 0; i < 60; ++i) xs.push_back(i / 10.0), ys.push_back(i % 3 == 0 ? 90 + i : 2 * xs.back() + 1);
  const auto residuals = [&](const std::vector<double>& v, std::vector<double>& out) {
    for (std::size_t i = 0; i < xs.size(); ++i)
      for (std::size_t c = 0; c < 3; ++c) out[3 * i + c] = v[0] * xs[i] + v[1] - ys[i];
  };
  const std::vector<double> importance(60, 1.0);
  auto found = robust_search({{0, 0.1, -10, 10}, {0, 0.1, -10, 10}}, importance, residuals);
  EXPECT_NEAR(found.values[0], 2, 0.05);
  EXPECT_NEAR(found.values[1], 1, 0.05);
  EXPECT_GT(found.condition, 1);
  found = robust_search({{0, 0.1, -10, 1.5}, {0, 0.1, -10, 10}}, importance, residuals);
  EXPECT_LE(found.values[0], 1.5);
}

// Textbook: the slope of a line through points of spread s has the error s / sqrt(sum (x - mean)^2); a value that
// nothing depends on may be anything. The bound is three times 1/sqrt(1200), to which 600 differences tell s.
TEST(SketchSolve, the_errors_of_values_are_those_of_a_line) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0, 0.1);
  std::vector<double> ys(600);
  for (double& y : ys) y = noise(random);
  const auto residuals = [&](const std::vector<double>& v, std::vector<double>& out) {
    for (std::size_t i = 0; i < ys.size(); ++i) out[i] = v[0] * static_cast<double>(i / 3) / 10 + v[1] - ys[i];
  };
  const auto found = robust_search({{1, 0.1, -10, 10}, {1, 0.1, -10, 10}, {1, 0.1, -10, 10}},
                                   std::vector<double>(200, 1.0), residuals);
  double squares = 0;
  for (int i = 0; i < 200; ++i) squares += 3 * (i / 10.0 - 9.95) * (i / 10.0 - 9.95);
  ASSERT_EQ(found.error.size(), 3U);
  EXPECT_NEAR(found.error[0] / (0.1 / std::sqrt(squares)), 1, 0.1);
  EXPECT_GT(found.error[2], 1e9);
}

TEST(SketchSolve, a_color_beyond_all_light_is_no_color_of_a_paint) {
  const auto rgb = [](const Lab& lab) { return rgb_from_lab(lab, *white_point({})); };
  EXPECT_TRUE(is_paint_color(rgb({75, -5, -20}), 0.01));
  EXPECT_TRUE(is_paint_color(rgb({130, 10, 30}), 0.01));  // brighter than white, as metal is
  EXPECT_FALSE(is_paint_color(rgb({71, -202, -28}), 10));
  const Rgb outside{-0.001, 0.4, 0.4};
  EXPECT_FALSE(is_paint_color(outside, 0.01));
  EXPECT_TRUE(is_paint_color(outside, 10));
}

}  // namespace
}  // namespace goniochrome
