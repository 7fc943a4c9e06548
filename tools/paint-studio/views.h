// Traced views of a page: the light of a view of the mesh, in which the page shows every paint.
#pragma once

#include <string>
#include <vector>

#include "base/json.h"
#include "base/result.h"
#include "formats/basis.h"
#include "mesh/mesh.h"
#include "paint/paint.h"
#include "studio/packed_numbers.h"

namespace goniochrome::tool {

struct PackedTracedView {
  Json json;              // the view, its camera and its light; its numbers stand in `numbers`
  Json figures;           // of the report
  double error_de00 = 0;  // what packing changes in the paints of the page, p95
};

// The view in a picture that render-osmesa wrote with --aov transport. Packing is judged by some of the paints. Error:
// a file that has no transport or is damaged, one that shows another mesh, a basis whose lobes it lacks.
Result<PackedTracedView> packed_traced_view(const std::string& path, const std::string& name, const mesh::Mesh& mesh,
                                            const formats::Basis& basis, const std::vector<paint::Paint>& paints,
                                            studio::PackedNumbers& numbers);

}  // namespace goniochrome::tool
