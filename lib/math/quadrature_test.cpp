#include "math/quadrature.h"

#include <gtest/gtest.h>

#include <cmath>

namespace goniochrome::math {
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

}  // namespace
}  // namespace goniochrome::math
