// The inks of a CMYK JPEG. OpenImageIO 2.4 makes RGB of them, from which they cannot be told any more.
#pragma once

#include <string>
#include <vector>

namespace goniochrome::image {

// Fills `pixels` (4 width height) with C, M, Y and K from the top, of which 1 is full ink. A YCCK file is turned to
// CMYK. Returns "", or why the file cannot be read; it must have that size.
std::string read_cmyk_jpeg(const char* path, int width, int height, std::vector<float>& pixels);

}  // namespace goniochrome::image
