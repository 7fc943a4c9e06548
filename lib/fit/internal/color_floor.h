// How near one color can be to several colors at once: what no fit can come below whose color at an aspecular angle is
// the same for all views, where the readings at that angle differ. goniochrome-fitting(7), "FITTING".
#pragma once

#include <vector>

#include "color/color.h"

namespace goniochrome::fit {

struct ColorFloor {
  double sum_de00 = 0;      // the least sum of the CIEDE2000 differences between the colors and one color
  double largest_de00 = 0;  // the least value of the largest of these differences
};

// Returns the floor of at least two colors. `apart_de00` is the largest difference between two of them, and above 0.
// Each value is that of a color that was found, so it is never below the true one. Of two colors that are at most 8
// apart, 95 % of the values are above it by less than 0.3 %, and the worst by 3 %; of several, the worst by 5 %.
ColorFloor color_floor(const std::vector<color::Lab>& colors, double apart_de00);

}  // namespace goniochrome::fit
