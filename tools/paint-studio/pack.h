// The data of a page as JSON. Numbers of meshes, maps and weights stand in it as base64 of little-endian binary.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/json.h"
#include "base/result.h"
#include "envmap/prefiltered.h"
#include "formats/basis.h"
#include "mesh/mesh.h"
#include "paint/paint.h"

namespace goniochrome::tool {

std::string base64(std::string_view bytes);

// Positions as 16 bits within the bounding box, normals as 16 bits an axis, and the parts with the row of their
// weights: 0 is the design, the others are finishes that nobody paints. `finishes` gets the weights of those rows.
struct PackedMesh {
  Json json;
  std::vector<paint::LobeFit> finishes;
};
PackedMesh packed_mesh(const mesh::Mesh& mesh, bool with_mirror);

// Cubes as half floats, with the program that draws by them. `white` is the luminance that exposure 0 brings to 1.
// Error: an environment that lacks a lobe of the basis.
Result<Json> packed_environment(const std::string& name, const envmap::PrefilteredEnvironment& env,
                                const formats::Basis& basis);

// The rows of weights of these finishes, one behind the other, and the size of a row.
Json packed_finishes(const std::vector<paint::LobeFit>& finishes, const formats::Basis& basis);

}  // namespace goniochrome::tool
