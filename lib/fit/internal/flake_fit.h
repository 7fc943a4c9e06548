// The flake part of a fit: K_D and K_DD from rows at aspecular angles, for all views together or view by view.
// Internal to lib/fit. goniochrome-theory(7), FITTING.
#pragma once

#include <algorithm>
#include <vector>

#include "base/clock.h"
#include "color/color.h"
#include "fit/internal/linear_fit.h"
#include "fit/paint_fit.h"

namespace goniochrome::fit {

// Where a color is seen: from specular, and the viewer from the normal.
struct FlakePoint {
  double aspecular_rad = 0, view_deg = 0;
};

struct FlakeRow {
  FlakePoint at;
  color::Rgb value;       // reflectance factor, channels >= 0
  double weight = 1;      // of the error
  bool inferred = false;  // steers between and beyond the readings
};

struct FlakeReading {
  FlakePoint at;
  color::Lab lab;
};

struct FlakeTarget {
  color::Xyz white;
  std::vector<FlakeRow> rows;
  std::vector<FlakeReading> readings;  // what the fit is judged by
};

// The columns of a fit: the constant and each exponent, once for all views or once for each view.
struct FlakeModel {
  std::vector<double> exponents;       // ascending
  std::vector<double> views_deg = {};  // ascending; weights are linear between two and constant beyond the ends

  int columns_per_view() const { return 1 + static_cast<int>(exponents.size()); }
  int columns() const { return columns_per_view() * std::max(1, static_cast<int>(views_deg.size())); }
  // What each column with weight 1 shows there.
  void shape(const FlakePoint& at, double* columns) const;
};

// The norm of a method; colors are compared by l2 where a linear problem must stand for them.
Norm norm_of(FitMethod method);

struct FlakeFit {
  std::vector<color::Rgb> x;                  // one triple per column, reflectance factors
  double objective = 0, plain_objective = 0;  // over the rows, as in PaintFitReport
  double optimality_gap = 0;
  FitStatus status = FitStatus::kOptimal;
};

// The color that weights show.
color::Rgb shown(const FlakeModel& model, const std::vector<color::Rgb>& x, const FlakePoint& at);

// The rows of a target as a linear problem in the columns of a model, in reflectance factor.
LinearProblem linear_problem(const FlakeTarget& target, const FlakeModel& model);

// The best weights. A model with views is also asked to show neighboring views alike, with so little weight that it
// decides only what no row does.
FlakeFit flake_fit(FitMethod method, const FlakeTarget& target, const FlakeModel& model, const Deadline& deadline);

}  // namespace goniochrome::fit
