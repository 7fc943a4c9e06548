// Radiance pictures (`*.hdr`) in memory. Most probes of light come in this format, and are read here, where
// OpenImageIO would take ten times longer to start than to read the picture.
#pragma once

#include <string>

#include "image/image.h"

namespace goniochrome::image {

// The picture, upright, as it was before the exposures and color corrections that its header names. The attribute
// `chromaticities` has its primaries; pixels of the kind XYZE are X, Y and Z, which these primaries say as well. Error:
// the line of the header that is not understood, or the row that ends early or whose runs are wrong; `name` is what
// errors call the file.
Result<ImagePart> decoded_hdr(const std::string& content, const std::string& name);

}  // namespace goniochrome::image
