#include "prefilter/internal/kernel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "math/cosine_power.h"
#include "prefilter/exact_lobe.h"
#include "prefilter/lobe_tree.h"
#include "prefilter/prefilter.h"

namespace goniochrome::prefilter::kernel_test {
namespace {

using BadPixels = envmap::Environment::BadPixels;

NumericKernel numeric_cosine(double exponent) {
  return NumericKernel([exponent](double angle) { return math::cos_power(angle, exponent); }, kPi / 2);
}

// A smooth hill of 35 deg, which has a support of its own: (1 + cos(pi angle / w)) / 2.
constexpr double kHill_rad = 0.6;
double hill(double angle) {
  return angle < kHill_rad ? (1 + std::cos(kPi * angle / kHill_rad)) / 2 : 0;
}

// k_l is the integral of (E+1) t^E P_l(t) over 0..1.
TEST(Kernel, CosineMultipliersEqualTheIntegral) {
  for (const double exponent : {0.0, 0.3, 1.0, 6.0, 70.0}) {
    const std::vector<double> k = CosineKernel(exponent).multipliers(12);
    for (int l = 0; l <= 12; ++l) {
      double sum = 0;
      constexpr int kSteps = 200000;
      for (int i = 0; i < kSteps; ++i) {
        const double s = (i + 0.5) / kSteps, t = std::pow(s, 4);  // finer near 0, where t^0.3 bends
        sum += (exponent + 1) * std::pow(t, exponent) * std::legendre(static_cast<unsigned>(l), t) * 4 * s * s * s /
               kSteps;
      }
      EXPECT_NEAR(k[l], sum, 2e-7) << exponent << " " << l;
    }
  }
}

// The values of cos^E alone, against its closed forms.
TEST(Kernel, ValuesAloneGiveTheClosedForms) {
  for (const double exponent : {1.0, 6.0, 70.0, 900.0}) {
    const CosineKernel closed(exponent);
    const NumericKernel numeric = numeric_cosine(exponent);
    EXPECT_NEAR(numeric.scale() / closed.scale(), 1, 1e-12) << exponent;
    // Half the height of cos^E and of the bell as sharp: 1 + ln 2 / (6 E) to first order, and E = 1 differs most.
    EXPECT_NEAR(numeric.sharpness() / closed.sharpness(), 1, 0.15 / exponent) << exponent;
    EXPECT_NEAR(numeric.support_rad(), closed.support_rad(), 1e-6 + 0.02 * closed.support_rad()) << exponent;
    const std::vector<double> want = closed.multipliers(300), got = numeric.multipliers(300);
    // A cosine that is rounded by one part in 2/eps changes cos^E by E times that. Both recurrences, that of the closed
    // form and that of the Legendre functions, round once for each degree, and nodes and weights some times more.
    for (int l = 0; l <= 300; ++l)
      EXPECT_NEAR(got[l], want[l], (exponent + 2 * l + 16) * std::numeric_limits<double>::epsilon())
          << exponent << " " << l;
    EXPECT_NEAR(numeric.norm_beyond(12), closed.norm_beyond(12), 1e-6 * (1 + closed.norm_beyond(12))) << exponent;
    for (const double angle : {0.05, 0.3, 0.8}) {
      const double t = std::cos(angle), k = closed.value(t);
      EXPECT_NEAR(numeric.value(t), k, 1e-12) << exponent;
      if (k < 1e-12) continue;
      EXPECT_NEAR(numeric.slope(t, k), closed.slope(t, k), 1e-6 * closed.slope(t, k)) << exponent;
      EXPECT_NEAR(numeric.near_edge(0.01), closed.near_edge(0.01), 1e-4 * exponent * closed.near_edge(0.01));
      EXPECT_NEAR(numeric.variation(angle), std::max(closed.variation(angle), numeric.sharpness()),
                  1e-5 * closed.variation(angle))
          << exponent;
      const double bend = closed.bend(t - 1e-3, t, closed.value(t - 1e-3), k);
      EXPECT_NEAR(numeric.bend(t - 1e-3, t, 0, 0), bend, 1e-3 * bend + 1e-4) << exponent;
    }
    // Half of the parallelogram lies beyond the edge, which 32 parts place to 1/64. Of sharp powers nothing is left at
    // this angle, so that their means, up to 1e-10, are told apart from 0 by the absolute part.
    const double mean = closed.linear_mean(0, 0.1, 0.03);
    EXPECT_NEAR(numeric.linear_mean(0, 0.1, 0.03), mean, 5e-3 * std::min(exponent, 10.0) * mean + 1e-12) << exponent;
  }
}

// Every method with a kernel that nothing is known of but its values, against sums over 8 x 8 points to a texel.
TEST(Kernel, OfValuesAloneServesEveryMethod) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(0.1F, 2);
  image::Image image = {160, 80, 3, {}, {}};
  for (int i = 0; i < 160 * 80 * 3; ++i) image.data.push_back(unit(random));
  const envmap::Environment env = envmap::Environment::from_lat_long(image, BadPixels::kError, "noise").value();
  const auto kernel = std::make_shared<NumericKernel>(hill, kHill_rad);
  const auto truth = [&](const Vec3& d) {
    constexpr int kParts = 8;
    Vec3 sum;
    for (int row = 0; row < env.height(); ++row)
      for (int column = 0; column < env.width(); ++column) {
        const float* rgb = env.radiance(column, row);
        double weight = 0;
        for (int i = 0; i < kParts; ++i)
          for (int j = 0; j < kParts; ++j) {
            const double x = column + (i + 0.5) / kParts, y = row + (j + 0.5) / kParts;
            const double cosine = dot(d, env.direction_at(x, y));
            weight += hill(std::acos(std::min(1.0, cosine))) * env.solid_angle_density(x, y) / (kParts * kParts);
          }
        sum += weight * Vec3{rgb[0], rgb[1], rgb[2]};
      }
    // Over the integral of the hill, 2 pi times that of (1 + cos(q a)) / 2 sin a over 0..w with q = pi / w.
    const double q = kPi / kHill_rad, c = std::cos(kHill_rad);
    return (1 / (kPi * ((1 - c) + (1 + c) / (1 - q * q)))) * sum;
  };
  const LobeTree tree(env);
  for (const Vec3& d : {Vec3{0, 1, 0}, normalized({1, 0.2, -0.4}), normalized({-0.3, -0.5, 1})}) {
    const Vec3 want = truth(d), exact = reference_lobe(env, d, *kernel), walked = tree.lobe(d, *kernel, 1e-3);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(exact[c] / want[c], 1, 1e-4);
      EXPECT_NEAR(walked[c] / want[c], 1, 1e-3);
    }
  }
  constexpr double kTolerance = 1e-3;
  PrefilterRequest request = {{6}, false, 3, kTolerance};
  request.kernels = {kernel};
  const envmap::PrefilteredEnvironment result =
      prefiltered(env, request, prefilter_plan(env, request), [](const envmap::PrefilteredLobe&, double) {});
  ASSERT_EQ(result.lobes.size(), 2U);
  EXPECT_LE(lobe_error(env, result.lobes[1], *kernel, 4, 1, 1).max, kTolerance) << result.lobes[1].method;
  EXPECT_LE(lobe_error(env, result.lobes[0], 4, 1, 1).max, kTolerance);
  // Taken for a cosine power, it is another map.
  EXPECT_GT(lobe_error(env, result.lobes[1], 4, 1, 1).max, kTolerance);
}

}  // namespace
}  // namespace goniochrome::prefilter::kernel_test
