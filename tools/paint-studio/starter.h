// A mesh, a light and paints that a page begins with where none is named.
#pragma once

#include <vector>

#include "base/result.h"
#include "envmap/prefiltered.h"
#include "formats/basis.h"
#include "mesh/mesh.h"
#include "paint/paint.h"

namespace goniochrome::tool {

// A car of few, smooth forms: body, roof, glass, tires and rims; 4.4 m long, +Y up, +Z forward.
mesh::Mesh starter_mesh();

// A photographer's studio, filtered for the lobes of a basis: a large soft light above, a strip on either side, and
// walls that grow lighter toward the top.
Result<envmap::PrefilteredEnvironment> starter_light(const formats::Basis& basis);

// One paint of each kind that designers begin with.
std::vector<paint::Paint> starter_paints();

}  // namespace goniochrome::tool
