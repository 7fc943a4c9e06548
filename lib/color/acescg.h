// Linear ACEScg [S-2014-004], the working space of many renderers.
#pragma once

#include "color/color.h"

namespace goniochrome::color {

// Its white is that of ACES: colors are adapted to it, and from it, by Bradford's matrix.
Rgb rec2020_from_acescg(const Rgb& acescg);
Rgb acescg_from_rec2020(const Rgb& rec2020);

}  // namespace goniochrome::color
