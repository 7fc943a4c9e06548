// The linear problem behind every fit: weights >= 0, channel by channel the optimum of a norm. Internal to lib/fit.
// goniochrome-theory(7), FITTING.
#pragma once

#include <vector>

#include "base/vec3.h"
#include "math/least_squares.h"

namespace goniochrome::fit {

enum class Norm { kL1, kL2 };

// Rows: shape(i,j) is what column j with weight 1 shows in row i; value: what shall be seen there; weight >= 0.
struct LinearProblem {
  math::Matrix shape;
  std::vector<double> weight;
  std::vector<Vec3> value;

  explicit LinearProblem(int columns) : shape(0, columns) {}
  LinearProblem(math::Matrix m, std::vector<double> w, std::vector<Vec3> v)
      : shape(std::move(m)), weight(std::move(w)), value(std::move(v)) {}
  int rows() const { return shape.rows; }
  int columns() const { return shape.columns; }
};

struct LinearFit {
  std::vector<Vec3> x;        // one triple per column
  double objective = 0;       // |W(Mx-b)| over all rows and channels: their sum, or the root of the sum of squares
  double optimality_gap = 0;  // the largest of the channels; see least_squares.h
  bool converged = true;
};

// The x >= 0 of least norm, channel by channel and exactly. `converged` is false where l1_fit() gave up on a channel.
LinearFit linear_fit(Norm norm, const LinearProblem& problem);

// The problem with these columns alone.
LinearProblem with_columns(const LinearProblem& problem, const std::vector<int>& columns);

// What the weights show in each row.
std::vector<Vec3> predictions(const LinearProblem& problem, const std::vector<Vec3>& x);

// |W(Mx-b)| as LinearFit has it; with all weights 1 where `plain`.
double error_norm(Norm norm, const LinearProblem& problem, const std::vector<Vec3>& x, bool plain = false);

}  // namespace goniochrome::fit
