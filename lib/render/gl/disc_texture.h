// Lamps that are discs, as the shading program reads them. goniochrome-rendering(7), "LAMPS".
#pragma once

#include <vector>

#include "render/effects.h"

namespace goniochrome::render {

// RGBA texels, row by row.
struct FloatTexture {
  int columns = 0, rows = 0;
  std::vector<float> rgba;
};

// The texture "discs": for each light a row for each lobe, whose last texel holds first_chord and nodes_per_chord; then
// a row of the horizon.
FloatTexture disc_texture(const std::vector<Light>& lights, const Effects& effects);

// An element of the uniform "light_disc".
Vec3 disc_uniform(const Light& light);

}  // namespace goniochrome::render
