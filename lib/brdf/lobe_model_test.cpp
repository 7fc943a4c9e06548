#include "brdf/lobe_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/angles.h"
#include "base/hard_case_for_test.h"
#include "math/cosine_power.h"

namespace goniochrome::brdf {
namespace {

// cos^E of the double `angle`, whose cosine is taken in long double: sin^2 by the half angle keeps 1 - cos.
long double reference_power(double angle, double exponent) {
  const long double h = std::sin(static_cast<long double>(angle) / 2), versine = 2 * h * h;
  const long double log_cos =
      versine < 0.3L ? std::log1p(-versine) : std::log(std::cos(static_cast<long double>(angle)));
  return std::exp(exponent * log_cos);
}

TEST(HardCase, PowCosWithin1e12OfLongDouble) {
  double worst = 0, textbook = 0;
  int compared = 0, vanished = 0;
  for (double exponent : {0.3, 1.0, 7.5, 150.0, 3000.0, 1e4, 1e5, 1e6}) {
    for (double angle_deg = 1e-8; angle_deg < 89.9991; angle_deg *= 1.003) {
      const double angle = angle_deg * kPi / 180;
      const long double reference = reference_power(angle, exponent);
      const double ours = math::cos_power(angle, exponent);
      EXPECT_TRUE(std::isfinite(ours));
      if (reference < std::numeric_limits<double>::min()) {  // below the normal range there is no relative error
        EXPECT_LE(ours, 2 * std::numeric_limits<double>::min());
        ++vanished;
        continue;
      }
      ++compared;
      worst = worst_of(worst, static_cast<double>(std::abs(ours / reference - 1)));
      textbook = worst_of(textbook, static_cast<double>(std::abs(std::pow(std::cos(angle), exponent) / reference - 1)));
    }
    const double last = 89.999 * kPi / 180;
    if (exponent >= 60) continue;
    EXPECT_NEAR(math::cos_power(last, exponent) / static_cast<double>(reference_power(last, exponent)), 1, 1e-12);
  }
  EXPECT_GT(compared, 10000);
  EXPECT_GT(vanished, 100);
  // The control is pow(cos(angle), E).
  hard_case("pow-cos", {.what = "cos^E for E up to 1e6 and angles from 1e-8 to 89.999 deg",
                        .textbook = textbook,
                        .ours = worst,
                        .bound = 1e-12,
                        .unit = "relative"});
}

TEST(HardCase, PowCosFromVersine) {
  double ours = 0, textbook = 0;
  for (const double exponent : {1.0, 70.0, 1e6})
    for (const double versine : {0.0, 1e-20, 1e-12, 1e-7, 1e-4, 0.1, 0.5, 0.99}) {
      const long double reference = std::exp(exponent * std::log1p(-static_cast<long double>(versine)));
      if (reference < 1e-300L) continue;
      const auto error = [&](double value) { return static_cast<double>(std::abs(value / reference - 1)); };
      ours = worst_of(ours, error(math::cos_power_from_versine(versine, exponent)));
      textbook = worst_of(textbook, error(std::pow(1 - versine, exponent)));
    }
  hard_case("pow-cos",
            {.what = "cos^E from 1 - cos", .textbook = textbook, .ours = ours, .bound = 1e-12, .unit = "relative"});
  EXPECT_EQ(math::cos_power_from_versine(1, 3), 0);
  EXPECT_EQ(math::cos_power_from_versine(1.7, 0), 0);
}

TEST(LobeModel, PowerAtTheEndsOfItsDomain) {
  EXPECT_EQ(math::cos_power(0, 1e6), 1);
  EXPECT_EQ(math::cos_power(0.5, 0), 1);
  EXPECT_EQ(math::cos_power(kPi / 2, 0), 0);
  EXPECT_EQ(math::cos_power(2, 3), 0);
  EXPECT_EQ(math::cos_power(-0.3, 20), math::cos_power(0.3, 20));
}

TEST(LobeModel, FresnelKnownValues) {
  const double at_normal = std::pow((1.5 - 1) / (1.5 + 1), 2);
  EXPECT_NEAR(fresnel_dielectric(1, 1.5), at_normal, 1e-16);
  // The three values the gloss standard is built on (ASTM D523 prints four digits).
  EXPECT_NEAR(fresnel_dielectric(std::cos(20 * kPi / 180), 1.567), 0.0491, 5e-5);
  EXPECT_NEAR(fresnel_dielectric(std::cos(60 * kPi / 180), 1.567), 0.1001, 1e-4);
  EXPECT_NEAR(fresnel_dielectric(std::cos(85 * kPi / 180), 1.567), 0.6192, 1e-4);
  EXPECT_NEAR(fresnel_dielectric(0, 1.5), 1, 1e-15);
  // Brewster's angle: half of r_s^2 alone, ((n^2-1)/(n^2+1))^2 / 2.
  const double n2 = 2.25;
  EXPECT_NEAR(fresnel_dielectric(1 / std::sqrt(1 + n2), 1.5), 0.5 * std::pow((n2 - 1) / (n2 + 1), 2), 1e-16);
  // From inside, past the critical angle.
  EXPECT_EQ(fresnel_dielectric(0.5, 1 / 1.5), 1);
}

TEST(LobeModel, FresnelOfMatchedIndexVanishesSmoothly) {
  for (const double c : {0.0, 1e-9, 0.3, 1.0}) EXPECT_EQ(fresnel_dielectric(c, 1), 0);
  // F ~ (n-1)^2 at normal incidence /4; the textbook (c-g)/(c+g) loses half the digits here.
  const double tiny = 0x1p-40;
  EXPECT_NEAR(fresnel_dielectric(1, 1 + tiny) / (tiny * tiny / 4), 1, 1e-11);
  EXPECT_NEAR(fresnel_dielectric(1, 1 - tiny) / (tiny * tiny / 4), 1, 1e-11);
}

paint::LobeFit sample_fit() {
  paint::LobeFit fit;
  fit.diffuse = {0.1, 0.05, 0.02};
  fit.lobes = {{20, {0.5, 0.4, 0.3}, {0, 0, 0}},
               {900, {0, 0.1, 0}, {2, 2, 2}},
               {std::numeric_limits<double>::infinity(), {}, {1, 1, 1}}};
  return fit;
}

TEST(LobeModel, BrdfAddsItsParts) {
  const paint::LobeFit fit = sample_fit();
  const Vec3 normal = {0, 0, 1};
  const double ti = 45 * kPi / 180, to = 30 * kPi / 180;  // 15 deg aspecular, in plane
  const Vec3 light = {-std::sin(ti), 0, std::cos(ti)}, view = {std::sin(to), 0, std::cos(to)};
  const double c20 = std::pow(std::cos(15 * kPi / 180), 20), c900 = std::pow(std::cos(15 * kPi / 180), 900);
  const color::Rgb f = brdf(fit, light, view, normal);
  EXPECT_NEAR(f.x, 0.1 + 0.5 * c20 + 2 * c900 / std::cos(ti), 1e-14);
  EXPECT_NEAR(f.y, 0.05 + 0.4 * c20 + 0.1 * c900 + 2 * c900 / std::cos(ti), 1e-14);
  EXPECT_EQ(brdf(fit, {0, 0, -1}, view, normal), color::Rgb{});
  EXPECT_EQ(brdf(fit, light, {0, 1, 0}, normal), color::Rgb{});
}

TEST(LobeModel, ViewsAreInterpolatedAndHeldAtTheEnds) {
  paint::LobeFit fit = sample_fit();
  fit.views = {{0, {0.1, 0, 0}, {{20, {1, 0, 0}, {}}}},
               {40, {0.3, 0, 0}, {{20, {0, 0, 0}, {2, 0, 0}}, {50, {4, 0, 0}, {}}}}};
  const auto at = [](double deg) { return Vec3{std::sin(deg * kPi / 180), 0, std::cos(deg * kPi / 180)}; };
  const auto lobe = [](double deg, double e) { return std::pow(std::cos(deg * kPi / 180), e); };
  const Vec3 light = at(-45), normal = {0, 0, 1};
  EXPECT_NEAR(brdf(fit, light, at(0), normal).x, 0.1 + lobe(45, 20), 1e-14);
  const double gloss = 2 / std::cos(45 * kPi / 180);
  EXPECT_NEAR(brdf(fit, light, at(40), normal).x, 0.3 + gloss * lobe(5, 20) + 4 * lobe(5, 50), 1e-12);
  EXPECT_NEAR(brdf(fit, light, at(60), normal).x, 0.3 + gloss * lobe(15, 20) + 4 * lobe(15, 50), 1e-12);
  // A quarter of the way, on either side of the normal.
  for (const double side : {1.0, -1.0}) {
    const double as = 45 - side * 10;
    EXPECT_NEAR(brdf(fit, light, at(side * 10), normal).x,
                0.75 * (0.1 + lobe(as, 20)) + 0.25 * (0.3 + gloss * lobe(as, 20) + 4 * lobe(as, 50)), 1e-12);
  }
  const paint::LobeFit quarter = at_view(fit, 10);
  EXPECT_TRUE(quarter.views.empty());
  ASSERT_EQ(quarter.lobes.size(), 2u);
  EXPECT_NEAR(brdf(quarter, light, at(10), normal).x, brdf(fit, light, at(10), normal).x, 1e-14);
  EXPECT_EQ(at_view(sample_fit(), 10).diffuse, sample_fit().diffuse);
}

TEST(LobeModel, ReflectanceFactorLeavesGlossOut) {
  const paint::LobeFit fit = sample_fit();
  const double c20 = std::pow(std::cos(15 * kPi / 180), 20);
  EXPECT_NEAR(flake_reflectance_factor(fit, 15).x, kPi * (0.1 + 0.5 * c20), 1e-14);
  EXPECT_NEAR(flake_reflectance_factor(fit, 0).y, kPi * (0.05 + 0.4 + 0.1), 1e-14);
  EXPECT_NEAR(flake_reflectance_factor(fit, 110).z, kPi * 0.02, 1e-16);
}

}  // namespace
}  // namespace goniochrome::brdf
