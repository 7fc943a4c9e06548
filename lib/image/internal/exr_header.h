// A look at the header of an EXR file before the library reads it.
#pragma once

#include <string>

namespace goniochrome::image {

// True if the headers of the EXR file `content` end within it, and each attribute has the size that its type asks for.
// The library allocates the size that a text states before it reads it, and reads other types without regard to their
// stated size: after one wrong size it takes arbitrary bytes for the size of the next text, and may ask for gigabytes.
// The layout is that of "OpenEXR File Layout", openexr.com. The magic number is not looked at.
bool is_sound_exr_header(const std::string& content);

}  // namespace goniochrome::image
