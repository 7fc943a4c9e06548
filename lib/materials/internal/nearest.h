// Nonlinear least squares within a box, for models of a dozen parameters.
#pragma once

#include <functional>
#include <vector>

namespace goniochrome::materials {

struct Parameter {
  double value, low, high;
};

// Moves the values, within low and high, to where the sum of squares of the residuals is least nearby: Levenberg's and
// Marquardt's method with forward differences. `residuals` fills a vector that always has the same length. Returns the
// sum of squares there.
double descend(std::vector<Parameter>& parameters,
               const std::function<void(const std::vector<Parameter>&, std::vector<double>&)>& residuals);

}  // namespace goniochrome::materials
