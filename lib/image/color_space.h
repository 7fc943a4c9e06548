// The color space that an image file claims, and the way from it to the working space.
#pragma once

#include "base/result.h"
#include "image/image.h"

namespace goniochrome::image {

// Turns the first three channels of `part` (one channel is gray) into linear working-space RGB, as its attributes say:
// colorInteropID, else chromaticities, else oiio:ColorSpace; untagged images are linear Rec.709. Whites are adapted to
// D65 by Bradford. Error: names a color space that is not known, and the remedy.
Result<Image> working_space_rgb(ImagePart part, const std::string& name);

}  // namespace goniochrome::image
