#include "math/quadrature.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "math/elementary.h"

namespace goniochrome::math {

// The points are the roots of the Legendre polynomial P_n, by Newton's method from Tricomi's approximation; with
// P_n' at a root the weight is 2 / ((1 - x^2) P_n'(x)^2). P_n comes from its three-term recurrence.
std::vector<QuadraturePoint> gauss_legendre(int n) {
  std::vector<QuadraturePoint> points(static_cast<std::size_t>(std::max(n, 0)));
  for (int k = 0; k < n; ++k) {
    double x = -math::cos(kPi * (k + 0.75) / (n + 0.5)), slope = 1;
    if (2 * k + 1 == n) x = 0;
    for (int step = 0; step < 20; ++step) {
      double p = 1, before = 0;
      for (int i = 0; i < n; ++i) {
        const double next = ((2 * i + 1) * x * p - i * before) / (i + 1);
        before = p, p = next;
      }
      slope = n * (before - x * p) / (1 - x * x);
      const double change = p / slope;
      x -= change;
      if (std::abs(change) <= 1e-16) break;
    }
    points[k] = {x, 2 / ((1 - x * x) * slope * slope)};
  }
  return points;
}

GaussRule gauss_rule(int points, int pieces) {
  const GaussPoints& piece_rule = kGaussPoints[static_cast<std::size_t>(points) - 1];
  GaussRule rule;
  for (int piece = 0; piece < pieces; ++piece)
    for (int i = 0; i < points; ++i) {
      rule.at.push_back((piece + piece_rule.at[i]) / pieces);
      rule.weight.push_back(piece_rule.weight[i] / pieces);
    }
  return rule;
}

}  // namespace goniochrome::math
