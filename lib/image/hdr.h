// Shared by the readers of this module and their tests.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "image/image.h"

namespace goniochrome::image {

// Whether a file that begins so may be a Radiance picture.
bool is_radiance(std::string_view head);

// A Radiance picture held in memory: rows from the top, columns from the left, linear RGB, as nearly all are. Nothing
// where it is of another kind (XYZ, turned, gamma-corrected), which read_image() leaves to OpenImageIO. Error: the row
// that ends early or whose runs are wrong; `name` is what errors call the file.
Result<std::optional<ImagePart>> decoded_hdr(const std::string& content, const std::string& name);

}  // namespace goniochrome::image
