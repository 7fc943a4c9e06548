// Pictures with an embedded ICC profile, brought to light. goniochrome-sketches(7), "SKETCH FITTING".
#pragma once

#include <string>

#include "base/result.h"
#include "color/print_gamut.h"
#include "image/image.h"

namespace goniochrome::image {

// How many of the first channels hold color: 1 is gray, 3 is RGB, and 4 is CMYK, whose channels are named so.
int color_channels(const Image& image);

// The picture as light: three channels in the working space, where 1 is the white of the profile's medium, which is
// paper for CMYK. The signals of `image` are 0..1, and 1 is full ink; floats (`whole_numbers` is false) may be beyond.
// `profile` holds the bytes of the ICC profile, and `name` is what errors call the image. Error, with the remedy: a
// damaged profile, a profile of another color space than gray, RGB and CMYK, or one that does not fit the channels of
// the image; a gray image may have an RGB profile.
Result<Image> image_through_icc(const Image& image, const std::string& profile, const std::string& name,
                                bool whole_numbers = true);

// The colors that a printer of this profile shows, relative to its paper: those that come back from its inks within 1.5
// dE76, as L*, a*, b* relative to D65. `name` is what errors call the profile. Error, with the remedy: bytes that are
// no profile, or one without tables toward the inks of a printer.
Result<color::PrintGamut> print_gamut(const std::string& profile, const std::string& name);

}  // namespace goniochrome::image
