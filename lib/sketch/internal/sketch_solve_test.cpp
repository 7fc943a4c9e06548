#include "sketch/internal/sketch_solve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace goniochrome::sketch::sketch_solve_test {
namespace {

TEST(NormalEquations, FindNonNegativeWeights) {
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

TEST(RobustSearch, PutsOutliersAsideAndStaysInItsDomain) {
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
TEST(RobustSearch, ErrorsOfValuesAreThoseOfALine) {
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

}  // namespace
}  // namespace goniochrome::sketch::sketch_solve_test
