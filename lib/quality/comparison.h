// A sample beside its standard: what it differs by at each geometry, and as a whole. Every difference is sample minus
// standard. goniochrome-color(7), "COLOR DIFFERENCES".
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "color/color_difference.h"
#include "paint/metrics.h"
#include "paint/paint.h"

namespace goniochrome::quality {

// The places of numbers that belong to no single geometry: the mean and the largest over the geometries, and the paint.
inline constexpr const char *kMean = "mean", *kLargest = "max", *kWhole = "paint";

// One number by which a sample differs from its standard.
struct Deviation {
  std::string at;        // the name of a geometry, or one of the places above
  std::string quantity;  // "dL"
  double value = 0;
};

struct AngleDifference {
  paint::Geometry geometry;
  color::Lab standard, sample;
  color::LabDifference lab;
  std::vector<double> by_formula;
};

struct CompareOptions {
  std::vector<color::DifferenceFormula> formulas;  // one or more
  std::vector<std::string> illuminants;            // under which metamerism is told
};

struct Comparison {
  std::string standard, sample;
  std::vector<AngleDifference> angles;  // ascending by library::geometry_order()
  AngleDifference mean, largest;        // over the geometries; the largest are those of the largest size, with sign
  std::vector<Deviation> others;        // indices, gloss, textures, metamerism
  std::vector<Deviation> missing;       // the sample lacks what its standard has for them; their values are NaN
  std::vector<std::string> remarks;     // what was converted or could not be compared
};

// A paint with what a comparison asks of it again and again.
struct Subject {
  paint::Paint paint;
  std::vector<paint::LabReading> rows;  // library::comparable_rows()
  paint::PaintMetrics metrics;
};

// Error: the paint has no color.
Result<Subject> subject_of(paint::Paint paint);

// Compares the two at the geometries that both have. Where their light differs, the one that has spectra is brought to
// the light of the other, the sample first. Textures are compared where instrument, quantity, version and geometry
// agree. Error, which lacks the names: nothing in common, or different light and no spectra.
Result<Comparison> compare(const Subject& standard, const Subject& sample, const CompareOptions& options);

// The name of the quantity that a formula gives: "dE_cmc:2:1".
std::string quantity_of(const color::DifferenceFormula& formula);

// All numbers of the comparison: of each geometry dL, da, db, dC, dH and dE by each formula, of kMean and kLargest dE
// alone, and the others.
std::vector<Deviation> deviations(const Comparison& comparison, const CompareOptions& options);

}  // namespace goniochrome::quality
