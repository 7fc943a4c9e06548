// Shared by the readers of this module and the module of the other formats.
#pragma once

#include <string>
#include <vector>

#include "image/image.h"

namespace goniochrome::image {

// Of one picture, 8 GB as floats; a forged header must not ask for more.
constexpr std::size_t kMostSamples = std::size_t{1} << 31;

// All parts of an EXR file held in memory; `name` is what errors call it.
Result<std::vector<ImagePart>> decoded_exr(const std::string& content, const std::string& name);

}  // namespace goniochrome::image
