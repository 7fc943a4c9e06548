// Which part wears which paint.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "mesh/mesh.h"
#include "options.h"
#include "paint/paint.h"

namespace goniochrome {

struct DressedMesh {
  std::vector<LobeFit> paints;         // for each part of the mesh
  std::vector<std::string> names;      // of those paints; "" where none was given
  std::vector<std::string> unpainted;  // names of the parts that wear the gray of unpainted parts
};

// Resolves --part and --paint. Error: an unknown part, paint or file, or a paint without lobes, with what there is.
Result<DressedMesh> dressed(const Mesh& mesh, const RenderOptions& options);

}  // namespace goniochrome
