// The map of the mirror lobe is the environment itself, averaged over the texels of the map.
// goniochrome-prefiltering(7), "The mirror".
#pragma once

#include <vector>

#include "envmap/environment.h"
#include "envmap/rotation.h"
#include "envmap/sphere_grid.h"

namespace goniochrome::prefilter {

// The mean radiance over each texel of a lat-long map or cube in the scene that `turn` brings the environment to: flux
// is kept. RGB, row by row.
std::vector<float> mirror_values(const envmap::Environment& env, const envmap::SphereGrid& grid,
                                 const envmap::Rotation& turn);

// True if an eighth of the map serves all of it, by turns and mirrors: a cube from an even lat-long map, not turned.
bool mirror_is_symmetric(const envmap::Environment& env, const envmap::SphereGrid& grid, const envmap::Rotation& turn);

}  // namespace goniochrome::prefilter
