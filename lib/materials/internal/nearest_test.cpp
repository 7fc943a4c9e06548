#include "materials/internal/nearest.h"

#include <gtest/gtest.h>

#include <cmath>

namespace goniochrome::materials::nearest_test {
namespace {

// Rosenbrock's valley, whose floor bends: the least sum, 0, is at (1, 1).
TEST(Nearest, FindsTheEndOfABentValley) {
  std::vector<Parameter> x = {{-1.2, -2, 2}, {1, -2, 2}};
  const double sum = descend(x, [](const std::vector<Parameter>& p, std::vector<double>& r) {
    r = {10 * (p[1].value - p[0].value * p[0].value), 1 - p[0].value};
  });
  EXPECT_LT(sum, 1e-6);
  EXPECT_NEAR(x[0].value, 1, 1e-3);
}

// With the least sum outside of the box, the end is the point of the box that is the best, here not the nearest one:
// the valley x + y = 3 runs along the corner.
TEST(Nearest, StaysInItsBoxAndGoesOnAlongItsWall) {
  std::vector<Parameter> x = {{0.5, 0, 1}, {0.5, 0, 1.5}};
  descend(x, [](const std::vector<Parameter>& p, std::vector<double>& r) {
    r = {3 * (p[0].value + p[1].value - 2.2), 0.1 * (p[0].value - 2)};
  });
  EXPECT_NEAR(x[0].value, 1, 1e-6);
  EXPECT_NEAR(x[1].value, 1.2, 1e-3);
}

}  // namespace
}  // namespace goniochrome::materials::nearest_test
