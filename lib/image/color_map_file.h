// Color maps as EXR files (goniochrome-paint(5), COLOR MAPS).
#pragma once

#include <string>

#include "base/result.h"
#include "brdf/color_map.h"
#include "image/image.h"

namespace goniochrome::image {

// Reads a map of RGB reflectance factors, twice as high as wide; its index is the file's, 1.5 where it tells none.
// Error: path and reason: another shape or an infinite value.
Result<brdf::ColorMap> read_color_map(const std::string& path);

// Writes the map with `attributes` (provenance) besides its own: goniochrome:colorMap and goniochrome:index.
Result<void> write_color_map(const std::string& path, const brdf::ColorMap& map, const Attributes& attributes);

}  // namespace goniochrome::image
