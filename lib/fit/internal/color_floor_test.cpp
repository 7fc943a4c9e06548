#include "fit/internal/color_floor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace goniochrome::fit::color_floor_test {
namespace {

using color::Lab;

// The reference: coordinate steps down to 1e-3, from the mean and from each color. It needs some thousand evaluations,
// so it is no part of the library.
template <class Cost>
double searched(const std::vector<Lab>& colors, double apart, const Cost& cost) {
  std::vector<Lab> starts = colors;
  Lab mean;
  for (const Lab& lab : colors) mean.L += lab.L, mean.a += lab.a, mean.b += lab.b;
  const double count = static_cast<double>(colors.size());
  starts.push_back({mean.L / count, mean.a / count, mean.b / count});
  double best = 1e9;
  for (Lab x : starts) {
    double value = cost(x);
    for (double step = apart / 4; step > 1e-3;) {
      bool moved = false;
      for (double Lab::*const channel : {&Lab::L, &Lab::a, &Lab::b})
        for (const double move : {step, -step}) {
          Lab next = x;
          next.*channel += move;
          const double next_value = cost(next);
          if (next_value < value) x = next, value = next_value, moved = true;
        }
      if (!moved) step /= 4;
    }
    best = std::min(best, value);
  }
  return best;
}

ColorFloor reference(const std::vector<Lab>& colors, double apart) {
  return {searched(colors, apart,
                   [&](const Lab& x) {
                     double sum = 0;
                     for (const Lab& lab : colors) sum += color::delta_e_2000(lab, x);
                     return sum;
                   }),
          searched(colors, apart, [&](const Lab& x) {
            double largest = 0;
            for (const Lab& lab : colors) largest = std::max(largest, color::delta_e_2000(lab, x));
            return largest;
          })};
}

// Random colors around one, the farthest two `apart` from each other to 1e-6.
std::vector<Lab> random_colors(int count, double apart, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> unit(0, 1);
  const Lab at = {10 + 80 * unit(random), 40 * normal(random), 40 * normal(random)};
  std::vector<Lab> turns(static_cast<std::size_t>(count));
  for (Lab& turn : turns) turn = {normal(random), normal(random), normal(random)};
  std::vector<Lab> colors(turns.size());
  for (double scale = 1, step = 0; step < 60; ++step) {
    for (std::size_t i = 0; i < colors.size(); ++i)
      colors[i] = {at.L + scale * turns[i].L, at.a + scale * turns[i].a, at.b + scale * turns[i].b};
    double most = 0;
    for (const Lab& a : colors)
      for (const Lab& b : colors) most = std::max(most, color::delta_e_2000(a, b));
    scale *= std::clamp(apart / most, 0.5, 2.0);
  }
  return colors;
}

struct Deviations {
  std::vector<double> sum, largest;  // relative to the reference
};

Deviations deviations(int count, double apart) {
  std::mt19937_64 random(7);
  Deviations out;
  for (int trial = 0; trial < 100; ++trial) {
    const std::vector<Lab> colors = random_colors(count, apart, random);
    const ColorFloor ours = color_floor(colors, apart), wanted = reference(colors, apart);
    out.sum.push_back(ours.sum_de00 / wanted.sum_de00 - 1);
    out.largest.push_back(ours.largest_de00 / wanted.largest_de00 - 1);
  }
  std::ranges::sort(out.sum);
  std::ranges::sort(out.largest);
  return out;
}

// Two colors: at most 0.3 % above the reference for 95 % of them. A search along the axes stops at the kink of the
// largest difference, so the reference itself is often above the straight line's middle, by up to 2 % at 4.
TEST(ColorFloor, OfTwoColorsIsThatOfTheLongSearch) {
  for (const double apart : {0.1, 0.5, 1.0, 2.0, 4.0, 8.0}) {
    const Deviations d = deviations(2, apart);
    EXPECT_LE(d.sum[94], 3e-3) << apart;
    EXPECT_LE(d.sum.back(), 0.03) << apart;
    EXPECT_GE(d.sum.front(), -0.03) << apart;
    EXPECT_LE(d.largest[94], 3e-3) << apart;
    EXPECT_LE(d.largest.back(), 0.03) << apart;
    EXPECT_LE(d.largest[50], 0) << apart << ": the middle is the better one for half of the pairs";
  }
}

TEST(ColorFloor, OfSeveralColorsIsNearThatOfTheLongSearch) {
  for (const int count : {3, 4})
    for (const double apart : {0.5, 2.0, 8.0}) {
      const Deviations d = deviations(count, apart);
      EXPECT_LE(d.sum[50], 2e-3) << count << " " << apart;
      EXPECT_LE(d.sum.back(), 0.03) << count << " " << apart;
      EXPECT_LE(d.largest[50], 5e-3) << count << " " << apart;
      EXPECT_LE(d.largest.back(), 0.05) << count << " " << apart;
    }
}

// Between grays CIEDE2000 is the difference of L* over 1 + .015 d^2 / sqrt(20 + d^2), d being the distance of the mean
// from L* 50 [Sharma2005]. Halfway between 49 and 51, d is 0.5 for either half.
TEST(ColorFloor, OfTwoGraysIsTheClosedForm) {
  const double half = 1 / (1 + 0.015 * 0.25 / std::sqrt(20.25));
  const ColorFloor floor = color_floor({{49, 0, 0}, {51, 0, 0}}, color::delta_e_2000({49, 0, 0}, {51, 0, 0}));
  EXPECT_NEAR(floor.sum_de00, 2 * half, 1e-5);
  EXPECT_NEAR(floor.largest_de00, half, 1e-5);
}

}  // namespace
}  // namespace goniochrome::fit::color_floor_test
