#include "brdf/lobe_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/angles.h"

namespace goniochrome::brdf::lobe_model_test {
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

// The mean over the hemisphere by a plain sum in the cosine.
double summed_transmission(double index) {
  constexpr int kSteps = 200000;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double c = (i + 0.5) / kSteps;
    sum += 2 * c * coat_transmission(c, index) / kSteps;
  }
  return sum;
}

TEST(Coat, LetsThroughWhatItDoesNotReflect) {
  for (const double c : {0.0, 0.1, 0.7, 1.0}) {
    EXPECT_EQ(coat_transmission(c, paint::kNoCoat), 1);
    EXPECT_EQ(coat_transmission(c, 1.5), 1 - fresnel_dielectric(c, 1.5));
  }
  for (const double index : {1.0, 1.5, 1.567, 1.7})
    EXPECT_NEAR(mean_coat_transmission(index), summed_transmission(index), 1e-6) << index;
  EXPECT_NEAR(mean_coat_transmission(1.5), 0.9082, 5e-5);  // F of diffuse light on n = 1.5 is .0918 in tables
}

// A white base that reads beta at 45/0. In even light a coat of n = 1.5 mirrors F and leaves T(theta) Tm of the base.
// The control is the textbook form, which adds the mirror image to the base.
TEST(Coat, AWhiteBaseNeverSendsBackMoreThanItGets) {
  double largest = 0, textbook = 0;
  for (const double beta : {0.9, 0.98, 1.0}) {
    const double base = beta / coat_passages(kCoatIndex, std::cos(45 * kDegree), 1);
    for (double theta = 0; theta < 90; theta += 0.25) {
      const double c = std::cos(theta * kDegree), mirrored = fresnel_dielectric(c, kCoatIndex);
      largest =
          std::max(largest, mirrored + coat_transmission(c, kCoatIndex) * mean_coat_transmission(kCoatIndex) * base);
      textbook = std::max(textbook, mirrored + beta);
    }
  }
  EXPECT_LE(largest, 1);
  EXPECT_GT(largest, 0.999);
  EXPECT_GT(textbook, 1.8);
}

// Central differences err by the square of their step, and by rounding over it.
TEST(Coat, ItsCosineHasTheDerivativesThatItTells) {
  constexpr double kStep = 1e-4;
  for (const double index : {1.0, 1.3, 1.5, 1.9})
    for (const double c : {0.02, 0.1, 0.3, 0.7, 0.99}) {
      const CoatedCosine at = coated_cosine(c, index);
      const auto value = [&](double cosine) { return cosine * coat_transmission(cosine, index); };
      EXPECT_NEAR(at.value, value(c), 1e-15);
      EXPECT_NEAR(at.slope, (value(c + kStep) - value(c - kStep)) / (2 * kStep), 1e-5);
      EXPECT_NEAR(at.bend, (value(c + kStep) - 2 * value(c) + value(c - kStep)) / (kStep * kStep), 1e-4);
    }
}

TEST(Coat, IsPassedTwiceByTheBaseAndNotByTheGloss) {
  paint::LobeFit fit = sample_fit();
  const Vec3 normal = {0, 0, 1};
  const auto at = [](double deg) { return Vec3{std::sin(deg * kDegree), 0, std::cos(deg * kDegree)}; };
  paint::LobeFit base = fit, gloss = fit;
  for (paint::Lobe& lobe : base.lobes) lobe.gloss = {};
  gloss.diffuse = {};
  for (paint::Lobe& lobe : gloss.lobes) lobe.directional_diffuse = {};
  fit.coat_index = 1.5;
  for (const double in : {-5.0, -45.0, -85.0})
    for (const double out : {0.0, 4.0, 60.0, 80.0}) {
      const double passages =
          coat_transmission(std::cos(in * kDegree), 1.5) * coat_transmission(std::cos(out * kDegree), 1.5);
      const color::Rgb wanted = passages * brdf(base, at(in), at(out), normal) + brdf(gloss, at(in), at(out), normal);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(brdf(fit, at(in), at(out), normal)[c], wanted[c], 1e-12 * (1 + wanted[c]));
      const double aspecular = std::abs(in + out);
      EXPECT_NEAR(flake_reflectance_factor(fit, aspecular, -in, out).y,
                  kPi * passages * brdf(base, at(in), at(out), normal).y, 1e-12);
    }
  // An instrument reads with light at 45 deg.
  EXPECT_EQ(flake_reflectance_factor(fit, 15), flake_reflectance_factor(fit, 15, 45, 30));
  EXPECT_EQ(flake_reflectance_factor(fit, 110), flake_reflectance_factor(fit, 110, 45, 65));
}

TEST(Coat, UnderAnotherCoatAPaintLooksTheSameAtTheUsualGeometry) {
  paint::LobeFit fit = sample_fit();
  fit.coat_index = 1.53;
  fit.views = {{0, fit.diffuse, fit.lobes}, {40, fit.diffuse, fit.lobes}};
  const auto at = [](double deg) { return Vec3{std::sin(deg * kDegree), 0, std::cos(deg * kDegree)}; };
  for (const double index : {paint::kNoCoat, 1.5, 1.53}) {
    const paint::LobeFit other = under_coat(fit, index);
    EXPECT_EQ(other.coat_index, index);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(brdf(other, at(-45), at(0), {0, 0, 1})[c] / brdf(fit, at(-45), at(0), {0, 0, 1})[c], 1, 1e-12);
    const double c60 = 0.5;
    EXPECT_NEAR(other.lobes.back().gloss.y * fresnel_dielectric(c60, mirror_index(index)),
                fit.lobes.back().gloss.y * fresnel_dielectric(c60, 1.53), 1e-12);
  }
  EXPECT_EQ(under_coat(fit, 1.53).diffuse, fit.diffuse);
}

}  // namespace
}  // namespace goniochrome::brdf::lobe_model_test
