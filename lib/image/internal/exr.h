// Parts that the readers of this room and the module of the other formats share.
#pragma once

#include <cstddef>
#include <string_view>

namespace goniochrome::image {

// The most samples that one picture may have, which are 8 GB as floats: a forged header must not ask for more.
constexpr std::size_t kMostSamples = std::size_t{1} << 31;

// True if a file that begins with `head` is an EXR file.
inline bool is_exr(std::string_view head) {
  return head.starts_with("\x76\x2f\x31\x01");
}

}  // namespace goniochrome::image
