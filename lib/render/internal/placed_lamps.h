// Lamps at a place, as the kernels and the programs of OpenGL have them: they find direction and strength at each
// point. goniochrome-rendering(7), "LAMPS".
#pragma once

#include <array>
#include <vector>

#include "render/scene.h"

namespace goniochrome::render {

// Data of a lamp for light_at(), in single precision. Lengths are in units of the mesh.
struct PlacedLamp {
  std::array<float, 3> position = {};  // from origin_of() the mesh
  float reach2 = 0;   // the square of the distance at which its light is that of the scene; 0: it is far away
  float least2 = 0;   // the square of the distance within which its light grows no more
  float radius2 = 0;  // of the sphere, squared
};

// Places each lamp, in order; nothing if all are far away.
std::vector<PlacedLamp> placed_lamps(const std::vector<Light>& lights, const Vec3& origin);

// Points and lamps are told from the middle of the mesh, so that single precision serves meshes far from 0.
Vec3 origin_of(const mesh::Mesh& mesh);

}  // namespace goniochrome::render
