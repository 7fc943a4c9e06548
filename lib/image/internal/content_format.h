// Which of the wanted image formats a file is of, told by its first bytes and never by its name.
#pragma once

#include <string>
#include <string_view>

#include "base/result.h"
#include "image/image.h"

namespace goniochrome::image {

// OpenImageIO's name of the format: "openexr", "hdr", "png", "jpeg", "tiff", "pnm", "dpx", "webp", "bmp" or "targa".
// Error: it is of no such format, or a camera's raw file, whose TIFF is but a thumbnail; the message says what the file
// is, if that can be told, and what to convert it to. `name` is what errors call the file.
Result<std::string> content_format(std::string_view content, const std::string& name);

// The EXIF orientation of a PNG, JPEG or WebP file, 1 to 8; 1 where it has none, and for other formats, whose decoders
// turn pictures.
int exif_orientation(std::string_view content, std::string_view format);

// False for a TGA or BMP whose header says that the fourth channel is no alpha, which decoders take it for.
bool has_alpha(std::string_view content, std::string_view format);

// The reason why a TGA or BMP would be decoded to wrong colors, and the remedy; "" where it is not.
std::string misread_colors(std::string_view content, std::string_view format);

// The attributes that a file states beside what its decoder hears: the ICC profile of a WebP or BMP, the primaries of a
// TIFF, and Adobe RGB by EXIF. None goes before an ICC profile that the decoder has found.
Attributes stated_colors(std::string_view content, std::string_view format);

}  // namespace goniochrome::image
