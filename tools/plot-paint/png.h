// From SVG to PNG by rsvg-convert.
#pragma once

#include <string>

#include "base/result.h"

namespace goniochrome::tool {

// The PNG of an SVG document. Error: rsvg-convert is not installed, or it failed.
Result<std::string> png_of(const std::string& svg);

}  // namespace goniochrome::tool
