// Formats that neither OpenEXR nor goniochrome-codecs.so reads.
#pragma once

#include <string>

#include "base/result.h"
#include "image/image.h"

namespace goniochrome::image {

// A picture of the PNM family, P1 to P6, as "Rec709", or a map of floats, PF or Pf, as linear light. Error: the fault and
// the remedy; `name` is what errors call the file.
Result<ImagePart> decoded_pnm(const std::string& content, const std::string& name);

// A picture of the format that OpenImageIO calls `format`, read by its program oiiotool, which lies beside this program
// or on the PATH. Error: the program is missing, or its words about the file.
Result<ImagePart> decoded_by_oiiotool(const std::string& content, const std::string& format, const std::string& name);

}  // namespace goniochrome::image
