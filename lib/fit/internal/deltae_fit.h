// The last polish of a fit: weights that make the CIEDE2000 differences at the readings least, from a linear fit's
// start. goniochrome-theory(7), FITTING.
#pragma once

#include <vector>

#include "base/clock.h"
#include "base/vec3.h"
#include "color/color.h"
#include "fit/internal/fit_status.h"

namespace goniochrome::fit {

// Predicted color of row i is sum_j shape(i,j) x_j, x_j >= 0 a working-space triple per column.
struct DeltaEProblem {
  int columns = 0;
  color::Xyz white;  // that the Lab values are relative to
  struct Reading {
    std::vector<double> shape;  // one per column
    color::Lab lab;
  };
  std::vector<Reading> readings;
  // Inferred rows, which steer where no reading is: residual weight * (prediction - value), in L*.
  struct Guide {
    std::vector<double> shape;
    color::Rgb value;
    double weight = 0;
  };
  std::vector<Guide> guides;
};

struct DeltaEFit {
  std::vector<color::Rgb> x;  // one per column
  double objective = 0;       // root of the sum of squared dE00 and squared guide residuals
  // The largest cosine between the residual and a free column of its derivative; 0 is stationary.
  double optimality_gap = 0;
  FitStatus status = FitStatus::kOptimal;
};

// The best of the local minima reached from each start; never worse than a start. Deterministic.
DeltaEFit deltae_fit(const DeltaEProblem& problem, const std::vector<std::vector<color::Rgb>>& starts,
                     const Deadline& deadline);

}  // namespace goniochrome::fit
