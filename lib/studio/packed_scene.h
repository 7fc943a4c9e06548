// The data of a page's stage as JSON: mesh, light and weights. Their numbers stand beside it, and the JSON has their
// places.
#pragma once

#include <string>

#include "base/json.h"
#include "base/result.h"
#include "envmap/prefiltered.h"
#include "formats/basis.h"
#include "mesh/mesh.h"
#include "studio/packed_numbers.h"

namespace goniochrome::studio {

// Positions as 16 bits within the bounding box, normals as 16 bits an axis, and the parts with the row of their
// weights: 0 is the design, 1 a second paint, and 2 to 4 are glass, rubber and chrome, for parts that nobody paints.
Json packed_mesh(const mesh::Mesh& mesh, PackedNumbers& numbers);

// Cubes as half floats, with the program that draws by them. `white` is the luminance that exposure 0 brings to 1.
// Error: an environment that lacks a lobe of the basis.
Result<Json> packed_environment(const std::string& name, const envmap::PrefilteredEnvironment& env,
                                const formats::Basis& basis, PackedNumbers& numbers);

// The lamp that a page has beside its environments: its extent in degrees, and its disc as the programs read it.
Json packed_lamp(const formats::Basis& basis, PackedNumbers& numbers);

// The layers in which a page keeps the light of a view, and the program that draws from them.
Json packed_layers(const formats::Basis& basis);

// The rows of weights from the second paint on, one behind the other, and the size of a row.
Json packed_finishes(const formats::Basis& basis, PackedNumbers& numbers);

}  // namespace goniochrome::studio
