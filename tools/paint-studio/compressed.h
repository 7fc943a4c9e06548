// Texts as a page holds them.
#pragma once

#include <string>
#include <string_view>

namespace goniochrome::tool {

// A gzip member in base64, which browsers decompress.
std::string compressed_text(std::string_view bytes);

}  // namespace goniochrome::tool
