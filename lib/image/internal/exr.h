// OpenEXR pictures in memory: what the readers of this room and the module of the other formats share.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "image/image.h"

namespace goniochrome::image {

// The most samples that one picture may have, which are 8 GB as floats: a forged header must not ask for more.
constexpr std::size_t kMostSamples = std::size_t{1} << 31;

// Whether a file that begins with `head` is an EXR file.
inline bool is_exr(std::string_view head) {
  return head.starts_with("\x76\x2f\x31\x01");
}

// All parts of an EXR file held in memory; `name` is what errors call it.
Result<std::vector<ImagePart>> decoded_exr(const std::string& content, const std::string& name);

}  // namespace goniochrome::image
