// Readings that lobes for all views cannot tell apart: at one aspecular angle, on both sides of specular or out of
// plane, with different colors. Internal to lib/fit. goniochrome-theory(7), FITTING.
#pragma once

#include <vector>

#include "color/color.h"
#include "paint/paint.h"

namespace goniochrome::fit {

// What no fit comes below whose color depends on the aspecular angle alone.
struct Twins {
  double apart_de00 = 0;             // the largest difference of two readings at one angle
  double sum_de00 = 0;               // least sum, over all readings at shared angles, of the differences to one color
                                     // for each angle
  std::vector<double> largest_de00;  // by angle: the least that the largest difference to one color can be
  std::vector<double> views_deg;     // of the readings that differ visibly from a twin, ascending
};

// All 0 and empty where no two readings at one unsigned aspecular angle differ.
Twins twins_of(const std::vector<paint::LabReading>& readings);

}  // namespace goniochrome::fit
