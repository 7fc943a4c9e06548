// Where on its texture each pixel lies, for the surfaces that have one. goniochrome-theory(7), SPATIALLY VARYING
// SURFACES.
#pragma once

#include <vector>

#include "mesh/mesh.h"
#include "render/camera.h"

namespace goniochrome {

struct TexturePlace {
  float u = 0, v = 0;
  float tangent[3] = {1, 0, 0};  // world, along u; of about unit length
};

// The places of the pixel centers of a picture; of pixels that miss the mesh they mean nothing. Texture coordinates are
// the mesh's own; where it has none, u runs once around the vertical axis through the middle of the bounding box and v
// upward in the same measure. `repeat` (> 0) multiplies both.
std::vector<TexturePlace> texture_places(const Mesh& mesh, const Rays& rays, const Vec3& eye, int width, int height,
                                         double repeat);

}  // namespace goniochrome
