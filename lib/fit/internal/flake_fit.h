// The flake part of a fit: the weights K_D and K_DD that show the colors of rows at aspecular angles, for all views
// together or view by view; and the linear problem behind it. goniochrome-fitting(7), "FITTING".
#pragma once

#include <algorithm>
#include <vector>

#include "base/clock.h"
#include "color/color.h"
#include "fit/paint_fit.h"
#include "math/least_squares.h"

namespace goniochrome::fit {

// The color with each negative channel set to 0: the nearest one that weights >= 0 can show.
inline color::Rgb non_negative(const color::Rgb& rgb) {
  return {std::max(rgb.x, 0.0), std::max(rgb.y, 0.0), std::max(rgb.z, 0.0)};
}

// The CIEDE2000 difference of two colors of the working space.
inline double color_difference(const color::Rgb& x, const color::Rgb& y, const color::Xyz& white) {
  return color::delta_e_2000(color::lab_from_rgb(x, white), color::lab_from_rgb(y, white));
}

// Where a color is seen: from specular, and the viewer from the normal.
struct FlakePoint {
  double aspecular_rad = 0, view_deg = 0;
};

struct FlakeRow {
  FlakePoint at;
  color::Rgb value;       // reflectance factor under the coat, channels >= 0
  double weight = 1;      // of the error
  bool inferred = false;  // the row was not read; it steers the weights between and beyond the readings
  bool held = false;      // the row is met if weights >= 0 can meet it together with all others that are held
};

struct FlakeReading {
  FlakePoint at;
  color::Lab lab;
  double passages = 1;  // what the coat leaves of the light of weights 1 there, see brdf::coat_passages()
};

struct FlakeTarget {
  color::Xyz white;
  std::vector<FlakeRow> rows;
  std::vector<FlakeReading> readings;       // what the fit is judged by
  std::vector<FlakeReading> usual = {};     // of many readings, what an instrument would read of them
  std::vector<FlakeRow> without_coat = {};  // under a coat: `rows` as they would be without it; otherwise empty
};

// The columns of a fit: the constant and each exponent, once for all views or once for each view.
struct FlakeModel {
  std::vector<double> exponents;       // ascending
  std::vector<double> views_deg = {};  // ascending; weights are linear between two and constant beyond the ends

  int columns_per_view() const { return 1 + static_cast<int>(exponents.size()); }
  int columns() const { return columns_per_view() * std::max(1, static_cast<int>(views_deg.size())); }
  // Values of each column with weight 1 there.
  void shape(const FlakePoint& at, double* columns) const;
};

enum class Norm { kL1, kL2 };

// The norm of a method. Where a linear problem must stand for color differences, it is l2.
Norm norm_of(FitMethod method);

// The linear problem behind every fit. shape(i,j) is the value of column j with weight 1 in row i, and `value` is the
// target of row i, whose error counts times weight >= 0.
struct LinearProblem {
  math::Matrix shape;
  std::vector<double> weight = {};
  std::vector<color::Rgb> value = {};

  int rows() const { return shape.rows; }
  int columns() const { return shape.columns; }
};

struct LinearFit {
  std::vector<color::Rgb> x;  // one triple per column
  double objective = 0;       // |W(Mx-b)| over all rows and channels: their sum, or the root of the sum of squares
  double optimality_gap = 0;  // the largest of the channels; see least_squares.h
  bool converged = true;      // false where l1_fit() gave up on a channel
};

// The x >= 0 of least norm, channel by channel and exactly.
LinearFit linear_fit(Norm norm, const LinearProblem& problem);

// The problem with these columns alone.
LinearProblem with_columns(const LinearProblem& problem, const std::vector<int>& columns);

// The color of the weights in each row.
std::vector<color::Rgb> predictions(const LinearProblem& problem, const std::vector<color::Rgb>& x);

struct FlakeFit {
  std::vector<color::Rgb> x;                  // one triple per column, reflectance factors
  double objective = 0, plain_objective = 0;  // over the rows, as in PaintFitReport
  // The gap of a linear method is that of LinearFit. Of kDeltaE the largest cosine between the residual, taken as no
  // shorter than kVisible_de00, and a free column of its derivative; it is 0 where the weights are stationary.
  double optimality_gap = 0;
  FitStatus status = FitStatus::kOptimal;
};

// The color that weights show.
color::Rgb shown(const FlakeModel& model, const std::vector<color::Rgb>& x, const FlakePoint& at);

// The rows of a target as a linear problem in the columns of a model, in reflectance factor.
LinearProblem linear_problem(const FlakeTarget& target, const FlakeModel& model);

// The best weights. A model with views is also asked to show neighboring views alike, with so little weight that this
// decides only what no row does.
FlakeFit flake_fit(FitMethod method, const FlakeTarget& target, const FlakeModel& model, const Deadline& deadline);

}  // namespace goniochrome::fit
