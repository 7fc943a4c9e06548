// Radiance pictures (`*.hdr`) in memory. Most probes of light come in this format, and are read here, where
// OpenImageIO would take ten times longer to start than to read the picture.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "image/image.h"

namespace goniochrome::image {

// Whether a file that begins with `head` may be a Radiance picture.
bool is_radiance(std::string_view head);

// The picture, linear RGB, if its rows run from the top and its columns from the left, as they do in nearly all such
// files. Nothing if it is of another kind (XYZ, turned, gamma-corrected), which read_image() leaves to OpenImageIO.
// Error: the row that ends early or whose runs are wrong; `name` is what errors call the file.
Result<std::optional<ImagePart>> decoded_hdr(const std::string& content, const std::string& name);

}  // namespace goniochrome::image
