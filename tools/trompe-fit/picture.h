// Pictures of before and after.
#pragma once

#include <vector>

#include "answer.h"
#include "base/result.h"
#include "image/image.h"
#include "mesh/mesh.h"
#include "panels/seam.h"

namespace goniochrome::tool {

// Draws flat panels as in [Shimizu2009] figure 4.4. There is a row for each geometry, in which the first panel stands
// above the second one: on the left in one paint, on the right with the paint found, and the differences beside them.
// Error: an illuminant without a known white.
Result<image::Image> swatches(const color::ViewingCondition& condition, const std::vector<Answer>& answers);

// Draws the mesh in its light as in [Shimizu2009] figure 4.6: on the left all in paint A, on the right the second part
// in paint B, and below them the differences along the seam. `env` may be null. Error: this machine has no OpenGL, or a
// part of `dark` is not there.
struct SeamPair {
  const mesh::Mesh* mesh = nullptr;
  const mesh::Seam* seam = nullptr;
  const envmap::PrefilteredEnvironment* env = nullptr;
  std::vector<Vec3> lights;
  Vec3 viewer;
  std::string part_b;
  std::vector<std::string> dark;  // parts drawn black
  paint::Paint a;
  Answer answer;
};
Result<image::Image> seam_pair(const SeamPair& pair);

}  // namespace goniochrome::tool
