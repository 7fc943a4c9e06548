#include "brdf/lafortune.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/angles.h"
#include "base/hard_case_for_test.h"
#include "brdf/lobe_model.h"

namespace goniochrome::brdf::lafortune_test {
namespace {

Vec3 direction(double polar_rad, double azimuth_rad) {
  return {std::sin(polar_rad) * std::cos(azimuth_rad), std::sin(polar_rad) * std::sin(azimuth_rad),
          std::cos(polar_rad)};
}

TEST(HardCase, LafortunePowerStaysInRange) {
  // |p|^n = 2^2000 with an albedo of 1e-300: exp(2000 log 2 + log 1e-300 ...), and a peak along the surface, weight 0.
  const LafortuneLobe strong = {{1e-300, 1e-300, 1e-300}, {-2, -2, 2}, 1500};
  const Vec3 viewer = direction(0.4, 0);
  const LobeFetch fetch = environment_fetch(strong, viewer);
  const long double expected = std::exp(1500 * std::log(2.0L) + std::log(1e-300L)) * std::cos(0.4L) * 2 * kPi / 1501;
  // The control takes |p|^n by pow.
  const double by_pow = std::pow(2.0, 1500) * 1e-300 * std::cos(0.4) * 2 * kPi / 1501;
  hard_case("lafortune-power", {.what = "rho |p|^n of 2^1500 and 1e-300",
                                .textbook = static_cast<double>(by_pow / expected - 1),
                                .ours = static_cast<double>(std::abs(fetch.weight.x / expected - 1)),
                                .bound = 1e-12,
                                .unit = "relative"});

  const LafortuneLobe flat = {{1, 1, 1}, {-2, -2, 0}, 1500};  // the peak lies in the surface: inf * 0 by pow
  EXPECT_EQ(environment_fetch(flat, viewer).weight, color::Rgb{});
  EXPECT_TRUE(std::isnan(std::pow(2.0, 1500) * std::max(0.0, 0.0)));

  // Overflow that nothing brings back stays finite.
  EXPECT_EQ(scaled_power(1, 2, 5000) <= std::numeric_limits<double>::max(), true);
  EXPECT_TRUE(std::isfinite(scaled_power(3, 2, 5000)));

  // A negative product is no light, whatever the exponent; pow gives NaN, or a positive lobe behind the surface.
  hard_case("lafortune-power", {.what = "light from behind, a negative product to the power 0.2",
                                .textbook = std::pow(-0.5, 0.2),
                                .ours = scaled_power(1, -0.5, 0.2),
                                .bound = 0,
                                .unit = "light"});
  EXPECT_EQ(scaled_power(1, -0.5, 2), 0);
  EXPECT_GT(std::pow(-0.5, 2), 0);

  // p = 0 has no direction.
  const LafortuneLobe nothing = {{1, 1, 1}, {0, 0, 0}, 0.2};
  EXPECT_EQ(environment_fetch(nothing, viewer).weight, color::Rgb{});
  EXPECT_EQ(environment_fetch(nothing, viewer).direction, (Vec3{0, 0, 1}));
  EXPECT_EQ(brdf({{}, {nothing}}, viewer, viewer), color::Rgb{});
}

TEST(HardCase, LafortunePowerSmallExponents) {
  for (const double n : {0.0, 0.2, 0.99, 1.0, 30.0, 1e4}) {
    for (const double x : {1e-300, 1e-8, 0.3, 0.999999, 1.0, 1.4}) {
      const long double expected = 2.5L * std::pow(static_cast<long double>(x), static_cast<long double>(n));
      if (expected < 1e-300L || expected > 1e300L) continue;
      EXPECT_NEAR(static_cast<double>(scaled_power(2.5, x, n) / expected), 1, 1e-12) << x << "^" << n;
    }
  }
}

TEST(Lafortune, PhongAxesAreACosineLobe) {
  const Lafortune surface = {{0.1, 0.2, 0.3}, {{{1, 0.5, 0.25}, {-1, -1, 1}, 20}}};
  const Vec3 wi = direction(0.6, 0.3), wo = direction(0.5, 3.2);
  paint::LobeFit fit;
  fit.diffuse = surface.diffuse;
  fit.lobes = {{20, surface.lobes[0].albedo, {}}};
  const color::Rgb expected = brdf(fit, wi, wo, {0, 0, 1}), got = brdf(surface, wi, wo);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c], expected[c], 1e-14);
  EXPECT_EQ(brdf(surface, {0, 0, -1}, wo), color::Rgb{});
  EXPECT_EQ(brdf(surface, wi, {1, 0, 0}), color::Rgb{});
}

TEST(Lafortune, IsReciprocal) {
  const Lafortune surface = {{}, {{{1, 1, 1}, {-0.9, 0.7, 0.8}, 3.5}}};
  const Vec3 wi = direction(0.6, 0.3), wo = direction(0.9, 1.2);
  EXPECT_NEAR(brdf(surface, wi, wo).x, brdf(surface, wo, wi).x, 1e-15);
}

// Under a constant environment L = 1, P_n = 1: the fetch is the integral of the lobe times the cosine at its peak. For
// a sharp lobe well above the horizon that is the integral of f cos_i, to the order 1/n.
TEST(Lafortune, FetchHasTheEnergyOfTheLobe) {
  const LafortuneLobe lobe = {{1, 1, 1}, {-0.8, -1.05, 1}, 400};
  const Vec3 viewer = direction(0.5, 0.8);
  double sum = 0;
  constexpr int kSteps = 1200;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      const double polar = kPi / 2 * (i + 0.5) / kSteps;
      const Vec3 wi = direction(polar, 2 * kPi * (j + 0.5) / kSteps);
      sum += brdf({{}, {lobe}}, wi, viewer).x * wi.z * std::sin(polar);
    }
  }
  sum *= kPi / 2 / kSteps * 2 * kPi / kSteps;
  EXPECT_NEAR(environment_fetch(lobe, viewer).weight.x / sum, 1, 1.0 / 400);
}

TEST(Lafortune, BlendsBetweenStoredExponents) {
  const std::vector<double> stored = {1, 4, 16, 64, 256};
  for (const auto& [n, lower, weight] :
       {std::tuple{0.2, 0, 0.0}, {1.0, 0, 0.0}, {2.0, 0, 0.5}, {64.0, 3, 0.0}, {128.0, 3, 0.5}, {1e4, 4, 0.0}}) {
    const ExponentBlend blend = exponent_blend(n, stored);
    EXPECT_EQ(blend.lower, lower) << n;
    EXPECT_NEAR(blend.upper_weight, weight, 1e-15) << n;
  }
  EXPECT_EQ(exponent_blend(0, stored).lower, 0);
}

}  // namespace
}  // namespace goniochrome::brdf::lafortune_test
