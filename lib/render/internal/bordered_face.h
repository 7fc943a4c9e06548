// Faces of cube maps for look-ups that cross their edges.
#pragma once

#include <vector>

#include "envmap/cube_map.h"

namespace goniochrome::render {

// A face with the texels of its neighbors around it, as seamless filtering has them (a corner is the mean of the three
// texels that meet there): (size + 2)^2 RGB triples.
std::vector<float> bordered_face(const envmap::CubeMap& map, int face);

}  // namespace goniochrome::render
