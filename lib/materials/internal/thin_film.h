// The reflectance of a thin film over a base, as glTF's extension KHR_materials_iridescence approximates it.
#pragma once

#include "color/color.h"

namespace goniochrome::materials {

// The reflectance of a film of that index and thickness in air at the cosine of incidence, in Rec.709, over a base that
// reflects `base` along the normal. The order of interference is cut after the second, so that a channel can be above
// 1.
color::Rgb film_reflectance(double film_index, double film_nm, const color::Rgb& base, double cosine);

}  // namespace goniochrome::materials
