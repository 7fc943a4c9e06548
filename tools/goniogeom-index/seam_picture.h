// The picture of a seam, colored by the difference of its panels.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "image/image.h"
#include "mesh/mesh.h"
#include "panels/seam.h"
#include "tool.h"

namespace goniochrome::tool {

struct SeamPicture {
  std::string title;
  double threshold = 2.3;
  std::vector<panels::SeamDifference> places;  // of the seam
};

// Draws the mesh in gray, with both panels lighter than the rest. Every place of the seam is a dot in the color of its
// largest difference, and a scale explains the colors. Error: this machine has no OpenGL.
Result<image::Image> seam_picture(const mesh::Mesh& mesh, const SeamRequest& request, const mesh::Seam& seam,
                                  const SeamPicture& picture);

}  // namespace goniochrome::tool
