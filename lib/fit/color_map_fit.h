// Color maps, which tell the color of a paint for every pair of directions, from readings at several angles of
// incidence or from a measured BRDF. goniochrome-interference(7), "ISOCHROMATIC LINES".
#pragma once

#include <optional>
#include <vector>

#include "base/result.h"
#include "brdf/color_map.h"
#include "brdf/measured.h"
#include "paint/paint.h"

namespace goniochrome::fit {

// The model that carries readings to other directions: isolines, or the aspecular angle in air alone. Near-matt paints,
// whose color hardly depends on the flakes' angle of incidence, are told better by the latter.
enum class ColorMapModel { kBetter, kIsolines, kAspecular };

struct ColorMapOptions {
  int size = 128;
  double index = 1.5;
  ColorMapModel model = ColorMapModel::kBetter;  // the one that predicts held-out readings better
  std::optional<double> isolines_power = {};     // above 0 to 1; none: what predicts held-out readings best
};

// One measured color: unit directions in the frame z = normal, and Lab.
struct ColorMapRow {
  Vec3 light, view;
  color::Lab lab;
};

struct ColorMapFit {
  brdf::ColorMap map;
  int rows = 0;           // from which the map is made
  int beyond_rows = 0;    // beyond the critical angle, where the map has no place: compared with it, and no part of it
  int glare_rows = 0;     // left out: within 10 deg of specular
  int grazing_rows = 0;   // left out: a direction more than 75 deg from the normal
  int illuminations = 0;  // different in-coat incidence angles, to 1 deg
  // Mean CIE 1976 differences over `compared_rows` real rows, each predicted from rows at other places by a model; and
  // the one of the model that the map has.
  double isolines_de76 = 0, aspecular_de76 = 0, held_out_de76 = 0;
  int compared_rows = 0;
  double isolines_power = 1;  // how far a reading tells the color at other places; 1 is the smoothest map
  // The standard error of the difference between both means. The rows of one light err together, so that it is found
  // from the lights. Nothing where all rows have one light.
  std::optional<double> difference_error_de76;
  double negative_share = 0;  // of texels with a negative channel: colors outside the working space
};

// The map whose isolines pass through all rows, or the map of the aspecular angle, whichever predicts rows that are
// left out better. A row that is out of plane stands at its in-plane equivalent. Rows at one place are averaged. Error:
// there are fewer than 4 usable rows, or all of them have one incidence angle, so that they tell a curve and no map.
Result<ColorMapFit> fit_color_map(const std::vector<ColorMapRow>& rows, const color::Xyz& white,
                                  const ColorMapOptions& options);

// From the rows of a measurement.
Result<ColorMapFit> fit_color_map(const paint::Measurement& measurement, const ColorMapOptions& options);

// From a measured BRDF, as Lab relative to `condition`. Of a file that lists directions, these are the rows. Of a grid,
// the rows are its values in plane at lights from 5 to 75 deg and viewers 5 deg apart, and the map is compared with
// the directions out of plane that samples() has.
Result<ColorMapFit> fit_color_map(const brdf::MeasuredBrdf& brdf, const color::ViewingCondition& condition,
                                  const ColorMapOptions& options);

}  // namespace goniochrome::fit
