// Color maps from what is measured in plane: rows of a multi-angle instrument at several illuminations, or a measured
// BRDF. goniochrome-theory(7), ISOCHROMATIC LINES.
#pragma once

#include <vector>

#include "base/result.h"
#include "brdf/color_map.h"
#include "brdf/measured.h"
#include "paint/paint.h"

namespace goniochrome::fit {

struct ColorMapOptions {
  int size = 128;
  double index = 1.5;
};

// One measured color: unit directions in the frame z = normal, and Lab.
struct ColorMapRow {
  Vec3 light, view;
  color::Lab lab;
};

struct ColorMapFit {
  brdf::ColorMap map;
  int rows = 0;               // that the map goes through
  int glare_rows = 0;         // left out: within 10 deg of specular
  int grazing_rows = 0;       // left out: a direction more than 75 deg from the normal
  int illuminations = 0;      // different in-coat incidence angles, to 1 deg
  double held_out_de76 = 0;   // mean over rows, each predicted from the others
  double negative_share = 0;  // of texels with a negative channel: colors outside the working space
};

// The map whose isolines pass through all rows, each row of an out-of-plane pair at its own in-plane equivalent. Rows
// of one place are averaged. Error: fewer than 4 usable rows, or all at one incidence angle: that is an aspecular
// curve.
Result<ColorMapFit> fit_color_map(const std::vector<ColorMapRow>& rows, const color::Xyz& white,
                                  const ColorMapOptions& options);

// From the rows of a measurement.
Result<ColorMapFit> fit_color_map(const paint::Measurement& measurement, const ColorMapOptions& options);

// From a measured BRDF: its values in plane at lights from 5 to 75 deg and viewers 5 deg apart, where the file has any.
// Relative to `condition`.
Result<ColorMapFit> fit_color_map(const brdf::MeasuredBrdf& brdf, const color::ViewingCondition& condition,
                                  const ColorMapOptions& options);

}  // namespace goniochrome::fit
