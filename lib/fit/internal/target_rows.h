// The rows a paint is fitted to: what is known, what lies between, and how the flake highlight goes on to specular.
// goniochrome-theory(7), FITTING.
#pragma once

#include <vector>

#include "base/result.h"
#include "color/color.h"
#include "paint/curve.h"
#include "paint/paint.h"

namespace goniochrome::fit {

// One row of the fit at an unsigned aspecular angle.
struct TargetRow {
  double angle_deg = 0;
  double view_deg = 0;            // of the viewer from the normal; of inferred rows: with light at 45 deg, in plane
  color::Rgb reflectance_factor;  // working space, negative channels set to 0
  double importance = 1;          // 1 for each reading that is known, less for what is inferred
  double lightness = 0;           // L*, for the perceptual weight
};

struct Target {
  std::vector<TargetRow> rows;
  double first_deg = 15;                    // the smallest angle at which the color is known
  double gamut_de00 = 0;                    // the largest color change from setting negative channels to 0
  int glare_rows = 0;                       // readings left out
  std::vector<paint::LabReading> readings;  // what the fit is judged by
};

// Readings at one aspecular angle make one row, unless `by_view`: then those from other views stand alone.
// Error: no color beyond glare. `white` is that of the paint's viewing condition. The highlight below first_deg rises
// no steeper than the sharpest of `exponents` that the samples see.
Result<Target> target_rows(const paint::Paint& paint, paint::TargetCurve::Kind kind, const color::Xyz& white,
                           const std::vector<double>& exponents, bool by_view = false);

// How the flake highlight goes on from the angle a toward specular, in rows every 5 deg from 0, by its color there and
// at b > a (reflectance factors, at least 0): no steeper than a lobe of the exponent `steepest`.
struct HighlightEnd {
  double a_deg = 0, b_deg = 0;
  color::Rgb at_a, at_b;
};
std::vector<TargetRow> extension_to_specular(const HighlightEnd& end, double steepest, const color::Xyz& white,
                                             double importance);

// The sharpest exponent that is seen from that angle on.
double steepest_seen(const std::vector<double>& exponents, double first_rad);

// The angle of the viewer of a geometry from the normal.
double view_angle_deg(const paint::Geometry& geometry);

}  // namespace goniochrome::fit
