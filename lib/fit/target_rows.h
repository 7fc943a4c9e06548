// The rows a paint is fitted to: what is known, what lies between, and how the flake highlight goes on to specular.
// goniochrome-theory(7), FITTING.
#pragma once

#include <vector>

#include "base/result.h"
#include "color/color.h"
#include "paint/curve.h"
#include "paint/paint.h"

namespace goniochrome {

// One row of the fit at an unsigned aspecular angle.
struct TargetRow {
  double angle_deg = 0;
  Rgb reflectance_factor;  // working space, negative channels set to 0
  double importance = 1;   // 1 for each reading that is known, less for what is inferred
  double lightness = 0;    // L*, for the perceptual weight
};

struct Target {
  std::vector<TargetRow> rows;
  double first_deg = 15;             // the smallest angle at which the color is known
  double gamut_de00 = 0;             // the largest color change from setting negative channels to 0
  int glare_rows = 0;                // readings left out
  std::vector<LabReading> readings;  // what the fit is judged by
};

// Error: no color beyond glare. `white` is that of the paint's viewing condition. The highlight below first_deg rises
// no steeper than the sharpest of `exponents` that the samples see.
Result<Target> target_rows(const Paint& paint, TargetCurve::Kind kind, const Xyz& white,
                           const std::vector<double>& exponents);

}  // namespace goniochrome
