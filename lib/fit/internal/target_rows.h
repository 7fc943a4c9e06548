// The targets of a paint for a fit, and the remaining errors: the rows that are known, those between them and those
// toward specular; the readings that no weights for all views can tell apart; and why a reading is not met any better.
// goniochrome-fitting(7), "FITTING".
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "color/color.h"
#include "fit/highlight_end.h"
#include "fit/internal/flake_fit.h"
#include "fit/paint_fit.h"
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
  double passages = 1;            // what a coat leaves of the base's light there, see brdf::coat_passages()
};

// The row as the fit has it: the color of the base under the coat, whose error counts by its visible part.
FlakeRow flake_row(const TargetRow& row, const FitOptions& options, bool inferred);

// A reading as the fit has it, under a coat of that index.
FlakeReading flake_reading(const paint::LabReading& reading, double coat_index);

struct Target {
  std::vector<TargetRow> rows;
  double first_deg = 15;                    // the smallest angle at which the color is known
  double gamut_de00 = 0;                    // the largest color change from setting negative channels to 0
  int glare_rows = 0;                       // readings left out
  std::vector<paint::LabReading> readings;  // what the fit is judged by
};

// The rows of a paint. Readings at one aspecular angle make one row; where `by_view` is true, those from different
// views stand alone. The highlight below first_deg rises no steeper than the sharpest of `exponents` that the samples
// see. `white` is that of the paint's viewing condition. Readings at one angle are averaged as colors of the base under
// a coat of that index. Error: the paint has no color beyond glare.
Result<Target> target_rows(const paint::Paint& paint, paint::TargetCurve::Kind kind, const color::Xyz& white,
                           const std::vector<double>& exponents, double coat_index = paint::kNoCoat,
                           bool by_view = false);

// How the flake highlight goes on toward specular, in rows every 5 deg from 0. It rises no steeper than a lobe of the
// exponent `steepest`.
std::vector<TargetRow> extension_to_specular(const HighlightEnd& end, double steepest, const color::Xyz& white,
                                             double importance, double coat_index);

// The angle of the viewer of a geometry from the normal, and the same to 1e-6 deg, as lobes by views name it.
double view_angle_deg(const paint::Geometry& geometry);
double named_view_deg(const paint::Geometry& geometry);

// The share of the base's light that a coat leaves there.
double coat_passages_at(const paint::Geometry& geometry, double coat_index);

// How far a color is from what weights >= 0 can show: dE00 between `lab`, which is `rgb` relative to `white`, and
// non_negative(rgb). It is 0 where no channel is negative.
double gamut_loss(const color::Lab& lab, const color::Rgb& rgb, const color::Xyz& white);

// Readings at one aspecular angle, on both sides of specular or out of plane, may have different colors. A color that
// depends on the aspecular angle alone cannot come closer to them than this.
struct Twins {
  double apart_de00 = 0;  // the largest difference of two readings at one angle
  double sum_de00 = 0;    // the least sum of the differences between all readings that share an angle and one
                          // color for each angle
  std::vector<double> largest_de00;  // by angle: the least that the largest difference to one color can be
  std::vector<double> views_deg;     // of the readings that differ visibly from a twin, ascending
};

// All 0 and empty where no two readings at one unsigned aspecular angle differ.
Twins twins_of(const std::vector<paint::LabReading>& readings);

// The limit of the worst reading of a fit, in words: its color is outside the working space, its twin on the other side
// of specular has another color (of a fit for all views), or a channel of the base under the coat grows away from
// specular; "" where none of these is true. `errors` are those of the readings, in their order; at least one.
std::string fit_limit(const std::vector<paint::LabReading>& readings, const std::vector<GeometryError>& errors,
                      const color::Xyz& white, double coat_index, bool by_view);

}  // namespace goniochrome::fit
