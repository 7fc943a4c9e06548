// The name of an output whose format does not depend on it.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "base/text.h"

namespace goniochrome::tool {

// For a tool that writes `format`, as in "an EXR", to a file of any name; `ending` is that of the format. Error (usage):
// the name ends as that of a picture or a document in another format does, whose programs could not open it.
inline Result<void> check_output_name(const std::string& path, std::string_view format, std::string_view ending) {
  constexpr std::array<std::string_view, 14> kEndings = {".ktx2", ".dds", ".exr", ".hdr", ".png", ".jpg", ".jpeg", ".tif",
                                                         ".tiff", ".bmp", ".gif", ".webp", ".pdf", ".svg"};
  const std::string name = lower(path);
  for (const std::string_view other : kEndings)
    if (other != ending && name.ends_with(other))
      return usage_error("--output is \"{}\": what is written is {}: give a name that ends in {}", path, format, ending);
  return {};
}

}  // namespace goniochrome::tool
