// --texture: which map lies on which part, and how.
#pragma once

#include "mesh/mesh.h"
#include "paints.h"
#include "tool.h"

namespace goniochrome::tool {

// Lays the maps of --texture on the mesh. A part without texture coordinates gets its map by a box unless the option
// says how. Error: an unknown part or word, a map that cannot be read, or `project=uv` where there are no coordinates.
Result<void> lay_textures(const mesh::Mesh& mesh, const Options& options, DressedMesh& dress);

}  // namespace goniochrome::tool
