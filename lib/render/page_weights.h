// The weights of paints as the programs of a page read them, see page_stage.h. They stand alone, since they are what a
// page computes anew for every edit.
#pragma once

#include <vector>

#include "render/effects.h"

namespace goniochrome::render {

// RGBA texels: a row for each paint of the scene, of 2 slots segments texels; see WeightTable.
std::vector<float> page_weights(const Scene& scene, const Effects& effects);

}  // namespace goniochrome::render
