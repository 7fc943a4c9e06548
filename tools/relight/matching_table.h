// Tables of color-matching functions.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "color/color.h"

namespace goniochrome::tool {

// Reads CSV rows of a wavelength and three values, at equal steps; a first line of names is passed over. Error: file,
// line and value.
Result<std::vector<color::Rgb>> read_matching_table(const std::string& path);

}  // namespace goniochrome::tool
