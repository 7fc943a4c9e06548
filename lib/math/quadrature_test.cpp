#include "math/quadrature.h"

#include <gtest/gtest.h>

#include <cmath>

namespace goniochrome::math::quadrature_test {
namespace {

TEST(Quadrature, GaussLegendreIsExactToItsDegree) {
  for (const int n : {1, 2, 3, 5, 8, 16, 33}) {
    const auto points = gauss_legendre(n);
    for (int degree = 0; degree < 2 * n; ++degree) {
      double sum = 0;
      for (const auto& [x, w] : points) sum += w * std::pow(x, degree);
      // n terms of size <= 1, each off by some ulp.
      EXPECT_NEAR(sum, degree % 2 ? 0.0 : 2.0 / (degree + 1), 4e-15) << n << " points, degree " << degree;
    }
  }
  EXPECT_TRUE(gauss_legendre(0).empty());
}

TEST(Quadrature, GaussLegendreConvergesOnSmoothFunctions) {
  double sum = 0;
  for (const auto& [x, w] : gauss_legendre(12)) sum += w * std::exp(x);
  EXPECT_NEAR(sum, std::exp(1.0) - std::exp(-1.0), 1e-15);
}

// Sums of x^k over 90 points on -0.8..0.5, those beside an end cut off: of few points they are the same up to degree
// 2n - 1; at 2n, the control, they are not.
TEST(Quadrature, FewerPointsHaveTheSumsOfMany) {
  std::vector<QuadraturePoint> many;
  for (int i = 0; i < 90; ++i) {
    const double x = -0.8 + 1.3 * i / 89;
    many.push_back({x, std::exp(-9 * x * x) / 30});
  }
  const auto sum = [](const std::vector<QuadraturePoint>& points, int degree) {
    double all = 0;
    for (const auto& [x, w] : points) all += w * std::pow(x / 0.8, degree);
    return all;
  };
  for (const int n : {1, 2, 5, 12, 30}) {
    const std::vector<QuadraturePoint> few = fewer_points(many, n);
    ASSERT_EQ(few.size(), static_cast<std::size_t>(n));
    for (int degree = 0; degree < 2 * n; ++degree) EXPECT_NEAR(sum(few, degree), sum(many, degree), 1e-14) << n;
    if (n < 8) {
      EXPECT_GT(std::abs(sum(few, 2 * n) - sum(many, 2 * n)), 1e-9) << n;
    }
  }
  EXPECT_EQ(fewer_points(many, 90).size(), 90U);
}

// n points integrate x^k over 0..1 up to k = 2n - 1 to rounding, the sum of at most 12 terms; at k = 2n, the control, a
// single piece errs by (n!)^4 / ((2n)!)^2.
TEST(Quadrature, GaussRuleIsExactUpToItsDegree) {
  for (int points = 1; points <= 4; ++points)
    for (const int pieces : {1, 3}) {
      const GaussRule rule = gauss_rule(points, pieces);
      ASSERT_EQ(rule.at.size(), static_cast<std::size_t>(points * pieces));
      const auto error = [&](int degree) {
        double sum = 0;
        for (std::size_t i = 0; i < rule.at.size(); ++i) sum += rule.weight[i] * std::pow(rule.at[i], degree);
        return std::abs(sum * (degree + 1) - 1);
      };
      for (int degree = 0; degree < 2 * points; ++degree) EXPECT_LE(error(degree), 2e-15) << points << " " << degree;
      if (pieces > 1) continue;
      EXPECT_NEAR(error(2 * points), std::pow(std::tgamma(points + 1), 4) / std::pow(std::tgamma(2 * points + 1), 2),
                  2e-15);
    }
}

}  // namespace
}  // namespace goniochrome::math::quadrature_test
