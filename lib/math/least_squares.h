// Fits with non-negative weights: they minimize |Mx - b| over x >= 0 in the 2-norm (NNLS) or in the 1-norm (a linear
// program). goniochrome-fitting(7), "FITTING".
#pragma once

#include <vector>

#include "base/result.h"

namespace goniochrome::math {

// Dense, column-major.
struct Matrix {
  int rows = 0, columns = 0;
  std::vector<double> values;
  Matrix(int r, int c) : rows(r), columns(c), values(static_cast<std::size_t>(r) * c, 0.0) {}
  double& operator()(int r, int c) { return values[static_cast<std::size_t>(c) * rows + r]; }
  double operator()(int r, int c) const { return values[static_cast<std::size_t>(c) * rows + r]; }
  const double* column(int c) const { return &values[static_cast<std::size_t>(c) * rows]; }
};

struct NonNegativeFit {
  std::vector<double> x;
  double objective = 0;       // |Mx-b|_2 or |Mx-b|_1
  double optimality_gap = 0;  // relative to |b|; 0 is proven optimal. nnls: the largest KKT residual with columns of
                              // length 1; l1_fit: the duality gap
  int iterations = 0;
  bool converged = true;  // false: the exact method gave up (never seen on 10^5 trials); x is feasible and its gap told
};

// Lawson-Hanson active sets on columns scaled to unit length, QR updated as columns come and go. Scale-free: nnls(M, s
// b) = s nnls(M, b). Columns of zeros, and columns that depend on others to the last bits, get weight 0. Values must be
// finite. Deterministic.
NonNegativeFit nnls(const Matrix& m, const std::vector<double>& b);

// Least absolute deviations: the exact vertex of a linear program by a simplex method on its dual, with the duality gap
// as proof. It is as scale-free and deterministic as nnls(), whose answer it returns (converged = false) should it
// fail.
NonNegativeFit l1_fit(const Matrix& m, const std::vector<double>& b);

}  // namespace goniochrome::math
