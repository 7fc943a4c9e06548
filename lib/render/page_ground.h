// The light of the ground below a mesh as a page keeps it: that of pictures. goniochrome-paths(7), "Ground".
#pragma once

#include <cstdint>
#include <vector>

#include "base/result.h"
#include "envmap/environment.h"
#include "mesh/mesh.h"

namespace goniochrome::render {

constexpr int kGroundSteps = 1023;
// Shares of the light of the open ground, see ground_below(), for some turns of the environment about +Y, in texels of
// four channels, 0 to kGroundSteps: what the mesh leaves, channel by channel, and the luminance that its painted parts
// would send if they reflected all even light, as a metallic paint does. Texels cover the whole plane: a place x, z
// from the middle of the mesh lies at 1/2 + p/(2 sqrt(1 + p^2)) of the texture's width and height, where p is x/reach
// and z/reach.
struct PageGroundLight {
  int size = 0, turns = 0;  // texels along a side
  double reach = 0;         // in units of the mesh
  std::vector<std::uint16_t> texels;
};
// Error: as RayScene has them.
Result<PageGroundLight> page_ground_light(const mesh::Mesh& mesh, const envmap::Environment& environment);

}  // namespace goniochrome::render
