// The picture of a seam, colored by the difference of its panels.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "fit/goniogeom_seam.h"
#include "image/image.h"
#include "mesh/mesh.h"
#include "options.h"

namespace goniochrome {

struct SeamPicture {
  std::string title;
  double threshold = 2.3;
  std::vector<SeamDifference> places;  // of the seam
};

// The mesh in gray, both panels lighter than the rest, every place of the seam as a dot in the color of its largest
// difference, and a scale. Error: no OpenGL on this machine.
Result<Image> seam_picture(const Mesh& mesh, const SeamRequest& request, const Seam& seam, const SeamPicture& picture);

}  // namespace goniochrome
