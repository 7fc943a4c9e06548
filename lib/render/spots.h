// Bright spots of an environment are drawn as lamps, which each horizon cuts exactly. What maps have of them is taken
// out of these, so that maps and lamps together have the light of the environment: in the shape that it really has,
// apart from the horizon. goniochrome-theory(7), RENDERING, Bright spots.
#pragma once

#include <vector>

#include "envmap/prefiltered.h"
#include "render/scene.h"

namespace goniochrome::render {

// The spot as a lamp. Mirrors do not show it, because they show the environment itself.
Light light_of(const envmap::Spot& spot);

// The map of the lobe of this exponent less what the spots give to it. Texels may come out below 0.
envmap::CubeMap without_spots(envmap::CubeMap map, double exponent, const std::vector<envmap::Spot>& spots);

// The same of the diffuse map or, where `coated`, of coat_diffuse_map().
envmap::CubeMap diffuse_without_spots(envmap::CubeMap map, bool coated, const std::vector<envmap::Spot>& spots);

}  // namespace goniochrome::render
