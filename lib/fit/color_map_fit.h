// Color maps, which tell the color of a paint for every pair of directions, from readings at several angles of
// incidence or from a measured BRDF. goniochrome-theory(7), ISOCHROMATIC LINES.
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
  int rows = 0;               // through which the map goes
  int glare_rows = 0;         // left out: within 10 deg of specular
  int grazing_rows = 0;       // left out: a direction more than 75 deg from the normal
  int illuminations = 0;      // different in-coat incidence angles, to 1 deg
  double held_out_de76 = 0;   // mean over rows, each predicted from the others
  double negative_share = 0;  // of texels with a negative channel: colors outside the working space
};

// The map whose isolines pass through all rows; a row that is out of plane stands at its in-plane equivalent. Rows at
// one place are averaged. Error: there are fewer than 4 usable rows, or all of them have one incidence angle, so that
// they tell a curve and no map.
Result<ColorMapFit> fit_color_map(const std::vector<ColorMapRow>& rows, const color::Xyz& white,
                                  const ColorMapOptions& options);

// From the rows of a measurement.
Result<ColorMapFit> fit_color_map(const paint::Measurement& measurement, const ColorMapOptions& options);

// From a measured BRDF: its values in plane at lights from 5 to 75 deg and at viewers 5 deg apart, as far as the file
// has them, as Lab relative to `condition`.
Result<ColorMapFit> fit_color_map(const brdf::MeasuredBrdf& brdf, const color::ViewingCondition& condition,
                                  const ColorMapOptions& options);

}  // namespace goniochrome::fit
