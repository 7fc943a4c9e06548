// EXR pictures in memory.
#pragma once

#include <string>
#include <vector>

#include "image/image.h"

namespace goniochrome::image {

// All parts of an EXR file held in memory; `name` is what errors call it.
Result<std::vector<ImagePart>> decoded_exr(const std::string& content, const std::string& name);

}  // namespace goniochrome::image
