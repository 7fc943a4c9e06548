// The shadow of a mesh on the ground below it.
#pragma once

#include "envmap/prefiltered.h"
#include "mesh/mesh.h"
#include "rays/ray_scene.h"
#include "studio/packed_numbers.h"

namespace goniochrome::tool {

// The part of its light that the ground keeps beside the mesh, per channel, and the light that the mesh would send
// there if it were white and matt, on a square around the mesh and for several turns of the environment. Members: size
// (texels along a side), turns, low[x, z] and side of the square, and texels, of one byte a channel: 255 is all of the
// light that the open ground has. Null for an environment without a mirror part, from which the light is taken.
Json packed_ground(const rays::RayScene& scene, const mesh::Mesh& mesh, const envmap::PrefilteredEnvironment& env,
                   studio::PackedNumbers& numbers);

}  // namespace goniochrome::tool
