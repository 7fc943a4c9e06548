// The linear spaces that files for other renderers are in.
#pragma once

#include "color/acescg.h"

namespace goniochrome::materials {

enum class ColorSpace { kRec709, kAcescg };

// From the working space into a space, and back.
inline color::Rgb into_space(ColorSpace space, const color::Rgb& rec2020) {
  return space == ColorSpace::kRec709 ? color::rec709_from_rec2020(rec2020) : color::acescg_from_rec2020(rec2020);
}
inline color::Rgb from_space(ColorSpace space, const color::Rgb& rgb) {
  return space == ColorSpace::kRec709 ? color::rec2020_from_rec709(rgb) : color::rec2020_from_acescg(rgb);
}

// Its name in MaterialX, and in the header of a table.
constexpr const char* name_of(ColorSpace space) {
  return space == ColorSpace::kRec709 ? "lin_rec709" : "acescg";
}

}  // namespace goniochrome::materials
