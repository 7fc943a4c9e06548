// The weights of paints as the programs of a page read them, see page_stage.h. They stand alone, since they are what a
// page computes anew for every edit.
#pragma once

#include <vector>

#include "brdf/ward.h"
#include "render/effects.h"

namespace goniochrome::render {

// RGBA texels: a row for each paint of the scene, of 2 slots segments texels; see WeightTable.
std::vector<float> page_weights(const Scene& scene, const Effects& effects);

// RGBA texels of the tilted normals over which a brushed paint is averaged: a row for each paint, all as long as the
// longest, of a normal in the frame of the surface and its share; what is left of a row is 0.
std::vector<float> tilt_texels(const std::vector<std::vector<brdf::Tilt>>& tilts);

}  // namespace goniochrome::render
