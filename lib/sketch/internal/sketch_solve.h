// The small solvers behind sketch fitting. goniochrome-sketches(7), "SKETCH FITTING".
#pragma once

#include <functional>
#include <vector>

namespace goniochrome::sketch {

// The normal equations of a weighted linear fit, gathered row by row.
class NormalEquations {
 public:
  explicit NormalEquations(int columns)
      : columns_(columns), gram_(static_cast<std::size_t>(columns) * columns, 0.0), right_(columns, 0.0) {}
  void add(const double* row, double value, double weight);
  // The x >= 0 of least weighted squares, by non-negative least squares on the Cholesky factor; columns that no row
  // sees get 0.
  std::vector<double> non_negative() const;

 private:
  int columns_;
  std::vector<double> gram_, right_;  // the lower triangle, row by row
};

// A number to find: where the search starts, how far a derivative steps, and its domain.
struct SearchParameter {
  double value = 0, step = 1, low = 0, high = 0;
};

struct SearchResult {
  std::vector<double> values;
  double cost = 0;       // robust_cost() at the end
  double condition = 0;  // of the derivatives at the end, each column of length 1
  int iterations = 0;
  std::vector<double> error = {};  // of each value, its standard error by the residuals at the end
};

// Least robust squares by Levenberg and Marquardt's damped steps with central differences. residuals(values, out) fills
// a group of three for each importance; r is the length of a group, and Cauchy's weights by the median of r put
// outliers aside. Deterministic.
using SearchResiduals = std::function<void(const std::vector<double>& values, std::vector<double>& out)>;
SearchResult robust_search(const std::vector<SearchParameter>& start, const std::vector<double>& importance,
                           const SearchResiduals& residuals);

// Cauchy's weights of the groups times their importance: one off by much more than the median counts little.
std::vector<double> robust_weights(const std::vector<double>& residuals, const std::vector<double>& importance);

// The mean of log(1 + r^2) by importance.
double robust_cost(const std::vector<double>& residuals, const std::vector<double>& importance);

}  // namespace goniochrome::sketch
