#include "brdf/lobe_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/angles.h"

namespace goniochrome::brdf {
namespace {

TEST(LobeModel, FresnelKnownValues) {
  const double at_normal = std::pow((1.5 - 1) / (1.5 + 1), 2);
  EXPECT_NEAR(fresnel_dielectric(1, 1.5), at_normal, 1e-16);
  // The three values the gloss standard is built on (ASTM D523 prints four digits).
  EXPECT_NEAR(fresnel_dielectric(std::cos(20 * kDegree), 1.567), 0.0491, 5e-5);
  EXPECT_NEAR(fresnel_dielectric(std::cos(60 * kDegree), 1.567), 0.1001, 1e-4);
  EXPECT_NEAR(fresnel_dielectric(std::cos(85 * kDegree), 1.567), 0.6192, 1e-4);
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
  const double ti = 45 * kDegree, to = 30 * kDegree;  // 15 deg aspecular, in plane
  const Vec3 light = {-std::sin(ti), 0, std::cos(ti)}, view = {std::sin(to), 0, std::cos(to)};
  const double c20 = std::pow(std::cos(15 * kDegree), 20), c900 = std::pow(std::cos(15 * kDegree), 900);
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
  const auto at = [](double deg) { return Vec3{std::sin(deg * kDegree), 0, std::cos(deg * kDegree)}; };
  const auto lobe = [](double deg, double e) { return std::pow(std::cos(deg * kDegree), e); };
  const Vec3 light = at(-45), normal = {0, 0, 1};
  EXPECT_NEAR(brdf(fit, light, at(0), normal).x, 0.1 + lobe(45, 20), 1e-14);
  const double gloss = 2 / std::cos(45 * kDegree);
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
  const double c20 = std::pow(std::cos(15 * kDegree), 20);
  EXPECT_NEAR(flake_reflectance_factor(fit, 15).x, kPi * (0.1 + 0.5 * c20), 1e-14);
  EXPECT_NEAR(flake_reflectance_factor(fit, 0).y, kPi * (0.05 + 0.4 + 0.1), 1e-14);
  EXPECT_NEAR(flake_reflectance_factor(fit, 110).z, kPi * 0.02, 1e-16);
}

}  // namespace
}  // namespace goniochrome::brdf
