#include "sketch/internal/sketch_trust.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/angles.h"
#include "paint/curve.h"

namespace goniochrome::sketch::sketch_trust_test {

namespace {

formats::Basis basis() {
  return {"two", {4, 20}, false};
}

// A gray base of reflectance .1 below a lobe of flake of this strength.
std::vector<color::Rgb> weights(double flake) {
  std::vector<color::Rgb> w(search_columns(basis()));
  w[0] = (0.1 / kPi) * color::Rgb{1, 1, 1};
  w[1] = (flake / kPi) * color::Rgb{1, 1, 1};
  return w;
}

double lightness(double reflectance) {
  return 116 * std::cbrt(reflectance) - 16;  // CIE 1976, above L* 8
}

SketchFit fit_at(std::initializer_list<double> angles_deg) {
  SketchFit fit;
  for (const double angle : angles_deg) fit.rows.push_back({{45, angle}, {50, 0, 0}});
  return fit;
}

}  // namespace

// The reflectance factor of the lobes is .1 + .5 cos^4 t, by hand.
TEST(SketchTrust, RowsAreReadOffTheLobesWhereTheyAreTold) {
  SketchFit fit = fit_at({15, 45, 110});
  take_shown(
      basis(), {weights(0.5)}, paint::kNoCoat, [](double angle) { return angle > 20; }, fit);
  ASSERT_EQ(fit.rows.size(), 5U);
  const double expected[] = {50, lightness(0.1 + 0.5 * 0.674675), lightness(0.1 + 0.5 * 0.25),
                             lightness(0.1 + 0.5 * 0.0044873), lightness(0.1)};
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(fit.rows[i].geometry.aspecular_deg, paint::kExportAngles_deg[i]);
    EXPECT_NEAR(fit.rows[i].lab.L, expected[i], 1e-3) << i;
  }
}

// A tenth of a unit of lightness is below what decides between the two models.
TEST(SketchTrust, RowsOfTheCurveStayWhereTheLobesAgree) {
  SketchFit fit = fit_at({110});
  fit.rows.front().lab = {lightness(0.1) + 0.1, 0, 0};
  take_shown(
      basis(), {weights(0.5)}, paint::kNoCoat, [](double) { return true; }, fit);
  EXPECT_EQ(fit.rows.back().lab.L, lightness(0.1) + 0.1);
}

// Twenty pixels that agree tell a color; nineteen do not, and neither do twenty among a hundred that disagree.
TEST(SketchTrust, FewPixelsLeaveAColorOpen) {
  std::vector<TrustPixel> pixels(20, {44, 1});
  pixels.insert(pixels.end(), 19, {111, 1});
  pixels.insert(pixels.end(), 20, {75, 1});
  pixels.insert(pixels.end(), 80, {75, 9});
  SketchFit fit = fit_at({15, 45, 75, 110});
  fit.extrapolated_deg = {15};
  take_thinly_seen(pixels, fit);
  ASSERT_EQ(fit.unsure.size(), 2U);
  EXPECT_EQ(fit.unsure[0].angle_deg, 75);
  EXPECT_EQ(fit.unsure[0].reason, "20 of the 100 pixels within 2 deg of it show the paint found, too few");
  EXPECT_EQ(fit.unsure[1].angle_deg, 110);
}

// At 15 deg the lobe of exponent 4 has .87 of its peak; at 110 deg it has nothing, so that its weight leaves L* alone.
TEST(SketchTrust, AnotherGlossWithAnotherColorIsTold) {
  SketchFit fit = fit_at({15, 110});
  take_open_by_gloss(basis(), {weights(0.5), 0, 0}, {{weights(0.5), 0, 0}, {weights(0.3), 40, 0}}, paint::kNoCoat, fit);
  ASSERT_EQ(fit.unsure.size(), 1U);
  EXPECT_EQ(fit.unsure[0].angle_deg, 15);
  ASSERT_TRUE(fit.unsure[0].de00.has_value());
  EXPECT_GT(*fit.unsure[0].de00, 5);
  EXPECT_EQ(fit.unsure[0].reason, "40 GU of gloss and another color there explain the pixels as well");
}

// cos^20 is .50 at 15, .14 at 25 and .001 at 45 deg. Gloss and the mirror are no color of the paint.
TEST(SketchTrust, ALobeLeftOutIsToldWhereItReaches) {
  SketchFit fit = fit_at({15, 25, 45, 110});
  take_left_out({"lobe-20", "gloss-900", "mirror", "shadow", "lobe-x"}, fit);
  ASSERT_EQ(fit.unsure.size(), 2U);
  EXPECT_EQ(fit.unsure[0].angle_deg, 15);
  EXPECT_EQ(fit.unsure[1].angle_deg, 25);
}

}  // namespace goniochrome::sketch::sketch_trust_test
