// The replacements for files and threads in WebAssembly.
#pragma once

#include <map>
#include <string>

#include "image/image.h"

namespace goniochrome::studio {

// All that was written to an OutputFile since it was cleared last.
std::string& written_text();

// The files that can be read, by their names. The parts of a ZIP archive stand beside it, unpacked: ARCHIVE/PART.
std::map<std::string, std::string>& given_files();

// The scan lines of an OpenEXR file stand beside it, unpacked.
constexpr const char* kLines = "/lines";

// The picture in an OpenEXR file of one part of scan lines, in half or float, without compression or with RLE, ZIPS or
// ZIP; others are refused by name.
Result<image::ImagePart> decoded_exr(const std::string& content, const std::string& name);

// Memory for the events of an XML text, which the page writes there.
std::string& event_text();

}  // namespace goniochrome::studio
