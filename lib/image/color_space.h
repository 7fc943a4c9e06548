// The color space that an image file says it is in, and the conversion from it to the working space.
#pragma once

#include "base/result.h"
#include "image/image.h"

namespace goniochrome::image {

// Turns the first three channels of `part` (one channel is gray) into linear working-space RGB. The color space is the
// one that the attribute colorInteropID names, or else that of an ICC profile, or else that of the chromaticities, with
// the curve of oiio:ColorSpace, or else oiio:ColorSpace; an image without any of them is linear
// Rec.709. A color space Rec709 is sRGB for whole numbers, and linear for floats. Whites are adapted to D65 by
// Bradford's method. Error: a color space that is not known, and the remedy.
Result<Image> working_space_rgb(ImagePart part, const std::string& name);

// The problem of an image that was read with Inks::kAsRgb: it was CMYK, and how to mend it; or "".
std::string inks_problem(const ImagePart& part, const std::string& name);

}  // namespace goniochrome::image
