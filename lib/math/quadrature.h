// Gauss-Legendre quadrature. goniochrome-theory(7), GLOSS.
#pragma once

#include <vector>

namespace goniochrome::math {

struct QuadraturePoint {
  double position, weight;
};

// The n points (ascending) and weights on [-1,1] that integrate polynomials of degree 2n-1 exactly, to rounding.
std::vector<QuadraturePoint> gauss_legendre(int n);

}  // namespace goniochrome::math
