// Before and after, to look at.
#pragma once

#include <vector>

#include "answer.h"
#include "base/result.h"
#include "image/image.h"
#include "mesh/mesh.h"
#include "panels/seam.h"

namespace goniochrome::tool {

// Flat panels: a row for each geometry, the first panel above the second, on the left in one paint and on the right
// with the paint found, and the differences beside. [Shimizu2009] figure 4.4. Error: an illuminant without a known
// white.
Result<image::Image> swatches(const color::ViewingCondition& condition, const std::vector<Answer>& answers);

// The mesh in its light: on the left all in paint A, on the right the second part in paint B, the differences along the
// seam below. [Shimizu2009] figure 4.6. `env` may be null. Error: no OpenGL, or a part of `dark` that is not there.
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
