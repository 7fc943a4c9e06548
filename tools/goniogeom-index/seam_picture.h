// The picture of a seam, colored by the difference of its panels.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "image/image.h"
#include "mesh/mesh.h"
#include "options.h"
#include "panels/seam.h"

namespace goniochrome::tool {

struct SeamPicture {
  std::string title;
  double threshold = 2.3;
  std::vector<panels::SeamDifference> places;  // of the seam
};

// The mesh in gray, both panels lighter than the rest, every place of the seam as a dot in the color of its largest
// difference, and a scale. Error: no OpenGL on this machine.
Result<image::Image> seam_picture(const mesh::Mesh& mesh, const SeamRequest& request, const mesh::Seam& seam,
                                  const SeamPicture& picture);

}  // namespace goniochrome::tool
