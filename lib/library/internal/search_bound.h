// A lower bound of CIEDE2000 over a box of colors: what lets a search that must be exact leave most paints out.
// goniochrome-theory(7), NEAREST PAINT.
#pragma once

#include "color/color.h"

namespace goniochrome::library {

// Colors with lower.L <= L <= upper.L, and so on.
struct LabBox {
  color::Lab lower, upper;
};

// A number that is never above delta_e_2000(color, y) for any y in `box`, up to rounding and the 1e-9 of chroma that
// CIEDE2000 calls gray (a slack of 1e-9 relative and 1e-8 absolute is ample). Of a box that is a point it is a bound
// for that point.
double de00_floor(const color::Lab& color, const LabBox& box);

}  // namespace goniochrome::library
