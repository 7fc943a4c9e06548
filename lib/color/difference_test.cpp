#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <random>

#include "base/angles.h"
#include "base/hard_case_for_test.h"
#include "color/color.h"

namespace goniochrome::color::difference_test {
namespace {

struct Pair {
  Lab x, y;
  double de00;
};

// The supplementary test data of G. Sharma, W. Wu, E. N. Dalal, The CIEDE2000 color-difference formula, 2005, table 1.
constexpr Pair kPublished[] = {
    {{50, 2.6772, -79.7751}, {50, 0, -82.7485}, 2.0425},
    {{50, 3.1571, -77.2803}, {50, 0, -82.7485}, 2.8615},
    {{50, 2.8361, -74.02}, {50, 0, -82.7485}, 3.4412},
    {{50, -1.3802, -84.2814}, {50, 0, -82.7485}, 1},
    {{50, -1.1848, -84.8006}, {50, 0, -82.7485}, 1},
    {{50, -0.9009, -85.5211}, {50, 0, -82.7485}, 1},
    {{50, 0, 0}, {50, -1, 2}, 2.3669},
    {{50, -1, 2}, {50, 0, 0}, 2.3669},
    {{50, 2.49, -0.001}, {50, -2.49, 0.0009}, 7.1792},
    {{50, 2.49, -0.001}, {50, -2.49, 0.001}, 7.1792},
    {{50, 2.49, -0.001}, {50, -2.49, 0.0011}, 7.2195},
    {{50, 2.49, -0.001}, {50, -2.49, 0.0012}, 7.2195},
    {{50, -0.001, 2.49}, {50, 0.0009, -2.49}, 4.8045},
    {{50, -0.001, 2.49}, {50, 0.001, -2.49}, 4.8045},
    {{50, -0.001, 2.49}, {50, 0.0011, -2.49}, 4.7461},
    {{50, 2.5, 0}, {50, 0, -2.5}, 4.3065},
    {{50, 2.5, 0}, {73, 25, -18}, 27.1492},
    {{50, 2.5, 0}, {61, -5, 29}, 22.8977},
    {{50, 2.5, 0}, {56, -27, -3}, 31.903},
    {{50, 2.5, 0}, {58, 24, 15}, 19.4535},
    {{50, 2.5, 0}, {50, 3.1736, 0.5854}, 1},
    {{50, 2.5, 0}, {50, 3.2972, 0}, 1},
    {{50, 2.5, 0}, {50, 1.8634, 0.5757}, 1},
    {{50, 2.5, 0}, {50, 3.2592, 0.335}, 1},
    {{60.2574, -34.0099, 36.2677}, {60.4626, -34.1751, 39.4387}, 1.2644},
    {{63.0109, -31.0961, -5.8663}, {62.8187, -29.7946, -4.0864}, 1.263},
    {{61.2901, 3.7196, -5.3901}, {61.4292, 2.248, -4.962}, 1.8731},
    {{35.0831, -44.1164, 3.7933}, {35.0232, -40.0716, 1.5901}, 1.8645},
    {{22.7233, 20.0904, -46.694}, {23.0331, 14.973, -42.5619}, 2.0373},
    {{36.4612, 47.858, 18.3852}, {36.2715, 50.5065, 21.2231}, 1.4146},
    {{90.8027, -2.0831, 1.441}, {91.1528, -1.6435, 0.0447}, 1.4441},
    {{90.9257, -0.5406, -0.9208}, {88.6381, -0.8985, -0.7239}, 1.5381},
    {{6.7747, -0.2908, -2.4247}, {5.8714, -0.0985, -2.2286}, 0.6377},
    {{2.0776, 0.0795, -1.135}, {0.9033, -0.0636, -0.5514}, 0.9082},
};

// CIEDE2000 as it is often written down: hue angles compared with 180 deg as they come (margin_deg = 0), and the mean
// of hues on both sides of 0 not turned by half a turn (wraps = false), or reached from the first hue by half the
// difference, which rounds otherwise than from the second (from_first = true).
double textbook_de00(const Lab& x, const Lab& y, double margin_deg, bool wraps, bool from_first = false) {
  const auto rad = [](double d) { return d * kDegree; };
  const auto hue = [](double a, double b) { return std::fmod(std::atan2(b, a) / kDegree + 360, 360); };
  const double mean_ab = (std::hypot(x.a, x.b) + std::hypot(y.a, y.b)) / 2;
  const double g = 0.5 * (1 - std::sqrt(std::pow(mean_ab, 7) / (std::pow(mean_ab, 7) + std::pow(25, 7))));
  const double ax = x.a * (1 + g), ay = y.a * (1 + g), cx = std::hypot(ax, x.b), cy = std::hypot(ay, y.b);
  const double hx = hue(ax, x.b), hy = hue(ay, y.b);
  double turn = hy - hx, mean = (hx + hy) / 2;
  if (cx * cy == 0) {
    mean = hx + hy;
  } else if (std::abs(turn) > 180 + margin_deg) {
    turn += turn > 0 ? -360 : 360;
    if (wraps) mean += mean < 180 ? 180 : -180;
  }
  if (from_first) mean = hx + turn / 2;
  const double dH = 2 * std::sqrt(cx * cy) * std::sin(rad(turn / 2)), C = (cx + cy) / 2, L = (x.L + y.L) / 2;
  const double T = 1 - 0.17 * std::cos(rad(mean - 30)) + 0.24 * std::cos(rad(2 * mean)) +
                   0.32 * std::cos(rad(3 * mean + 6)) - 0.2 * std::cos(rad(4 * mean - 63));
  const double sL = 1 + 0.015 * std::pow(L - 50, 2) / std::sqrt(20 + std::pow(L - 50, 2));
  const double rT = -2 * std::sqrt(std::pow(C, 7) / (std::pow(C, 7) + std::pow(25, 7))) *
                    std::sin(rad(60 * std::exp(-std::pow((mean - 275) / 25, 2))));
  const double l = (y.L - x.L) / sL, c = (cy - cx) / (1 + 0.045 * C), h = dH / (1 + 0.015 * C * T);
  return std::sqrt(l * l + c * c + h * h + rT * c * h);
}

// The printed values have four decimals, so 1e-4 is their last digit.
TEST(HardCase, De00Branches) {
  double ours = 0, unwrapped = 0;
  for (std::size_t i = 0; i < std::size(kPublished); ++i) {
    const auto& [x, y, published] = kPublished[i];
    ours = worst_of(ours, std::abs(delta_e_2000(x, y) - published));
    EXPECT_EQ(std::bit_cast<std::uint64_t>(delta_e_2000(x, y)), std::bit_cast<std::uint64_t>(delta_e_2000(y, x)))
        << "pair " << i + 1;
    unwrapped = worst_of(unwrapped, std::abs(textbook_de00(x, y, 1e-9, false) - published));
  }
  hard_case("de00-branches",
            {.what = "the 34 published pairs", .textbook = unwrapped, .ours = ours, .bound = 1e-4, .unit = "dE00"});
}

// Exactly opposite colors, as pair 14 has: the hues differ by 180 deg but for rounding, and the paper takes the mean of
// the two. Compared without a margin, rounding picks the branch, and the answer jumps.
TEST(HardCase, De00BranchesOfOppositeHues) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> axis(-60, 60);
  double ours = 0, textbook = 0;
  for (int i = 0; i < 20000; ++i) {
    const Lab x{50, axis(random), axis(random)}, y{50, -x.a, -x.b};
    const double wanted = textbook_de00(x, y, 1e-9, true);
    ours = worst_of(ours, std::abs(delta_e_2000(x, y) - wanted));
    textbook = worst_of(textbook, std::abs(textbook_de00(x, y, 0, true) - wanted));
  }
  hard_case("de00-branches",
            {.what = "exactly opposite hues", .textbook = textbook, .ours = ours, .bound = 1e-9, .unit = "dE00"});
}

TEST(HardCase, De00BranchesAreSymmetricEverywhere) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> lightness(0, 160), axis(-100, 100), small(-1e-3, 1e-3);
  int near = 0, far = 0;
  double ours = 0, textbook = 0;
  for (int i = 0; i < 300000; ++i) {
    const Lab x{lightness(random), axis(random), axis(random)};
    Lab y{lightness(random), axis(random), axis(random)};
    if (i % 3 == 1) y = {x.L, -x.a, -x.b};                                                // opposite hues
    if (i % 3 == 2) y = {x.L + small(random), x.a + small(random), x.b + small(random)};  // almost equal
    const double forth = delta_e_2000(x, y), back = delta_e_2000(y, x);
    ASSERT_TRUE(std::isfinite(forth));
    ours = worst_of(ours, std::abs(forth - back));
    textbook =
        worst_of(textbook, std::abs(textbook_de00(x, y, 1e-9, true, true) - textbook_de00(y, x, 1e-9, true, true)));
    (std::abs(hue_deg(x) - hue_deg(y)) <= 180 ? near : far)++;
  }
  EXPECT_GT(near, 10000);
  EXPECT_GT(far, 10000);
  hard_case("de00-branches",
            {.what = "dE00(x, y) against dE00(y, x)", .textbook = textbook, .ours = ours, .bound = 0, .unit = "dE00"});
}

TEST(HardCase, De00BranchesWithZeroChroma) {
  EXPECT_EQ(delta_e_2000({50, 0, 0}, {50, 0, 0}), 0);
  // Gray against a hue: the direction of the gray, which is rounding, must not matter.
  const double clean = delta_e_2000({50, 0, 0}, {50, 10, -20});
  for (const double a : {1e-17, -1e-17})
    for (const double b : {1e-17, -1e-17}) EXPECT_NEAR(delta_e_2000({50, a, b}, {50, 10, -20}), clean, 1e-12);
  // Two grays differ in lightness alone: dL/SL at the mean.
  EXPECT_NEAR(delta_e_2000({49, 0, 0}, {51, 0, 0}), 2, 1e-12);
}

TEST(Difference, De76IsTheLength) {
  EXPECT_DOUBLE_EQ(delta_e_76({50, 3, 0}, {50, 0, 4}), 5);
  EXPECT_EQ(delta_e_76({1e200, 0, 0}, {0, 0, 0}), 1e200);
}

TEST(Difference, VectorHasTheLengthOfTheDifference) {
  for (const double a : {-60.0, -1.0, 0.0, 3.0, 45.0})
    for (const double b : {-70.0, -2.0, 0.0, 0.5, 80.0}) {
      const Lab x{40, a, b}, y{43, a + 2, b - 5};
      EXPECT_NEAR(length(delta_e_2000_vector(x, y)), delta_e_2000(x, y), 1e-13 * delta_e_2000(x, y));
      EXPECT_EQ(length(delta_e_2000_vector(x, x)), 0);
    }
}

}  // namespace
}  // namespace goniochrome::color::difference_test
