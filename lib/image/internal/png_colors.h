// The colors that a PNG states, which OpenImageIO passes over.
#pragma once

#include <string_view>

#include "image/image.h"

namespace goniochrome::image {

// The attributes that the chunks of a PNG call for: chromaticities and oiio:ColorSpace by cICP, which goes before an
// ICC profile, or the chromaticities of cHRM where there is neither a profile nor sRGB. Code points that are not known
// here are an oiio:ColorSpace that says so.
Attributes png_colors(std::string_view content);

// The text of a PNG under that keyword, from an entry that is not compressed; "" where there is none.
std::string png_text(std::string_view content, std::string_view keyword);

}  // namespace goniochrome::image
