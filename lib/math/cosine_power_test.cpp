#include "math/cosine_power.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/angles.h"
#include "base/hard_case_for_test.h"

namespace goniochrome::math::cosine_power_test {
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
      const double angle = angle_deg * kDegree;
      const long double reference = reference_power(angle, exponent);
      const double ours = cos_power(angle, exponent);
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
    const double last = 89.999 * kDegree;
    if (exponent >= 60) continue;
    EXPECT_NEAR(cos_power(last, exponent) / static_cast<double>(reference_power(last, exponent)), 1, 1e-12);
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
      ours = worst_of(ours, error(cos_power_from_versine(versine, exponent)));
      textbook = worst_of(textbook, error(std::pow(1 - versine, exponent)));
    }
  hard_case("pow-cos",
            {.what = "cos^E from 1 - cos", .textbook = textbook, .ours = ours, .bound = 1e-12, .unit = "relative"});
  EXPECT_EQ(cos_power_from_versine(1, 3), 0);
  EXPECT_EQ(cos_power_from_versine(1.7, 0), 0);
}

TEST(CosinePower, HoldsAtTheEndsOfItsDomain) {
  EXPECT_EQ(cos_power(0, 1e6), 1);
  EXPECT_EQ(cos_power(0.5, 0), 1);
  EXPECT_EQ(cos_power(kPi / 2, 0), 0);
  EXPECT_EQ(cos_power(2, 3), 0);
  EXPECT_EQ(cos_power(-0.3, 20), cos_power(0.3, 20));
}

}  // namespace
}  // namespace goniochrome::math::cosine_power_test
