// The table of weights as the shading program reads it.
#pragma once

#include <vector>

#include "render/effects.h"
#include "render/internal/product_forms.h"

namespace goniochrome::render {

// The RGBA texels of the table; where products are taken in four forms, the weights that meet maps are in these forms.
std::vector<float> gl_weights(const WeightTable& table, const ProductForms& forms);

}  // namespace goniochrome::render
