// Spectra for colors: a light or a reflectance of which three channels are known, in bands.
// goniochrome-color(7), "LIGHT IN BANDS".
#pragma once

#include "color/bands.h"

namespace goniochrome::color {

// The bands >= 0 of that color for this eye whose differences from `shape` change least from band to band; with no
// shape they are the smoothest of the color. A color without such bands gets the nearest. color_bands_test.cpp holds
// the smoothest bands beside those of [Glassner1989], [Smits1999] and [JakobHanika2019].
Bands bands_of_color(const Rgb& wanted, const BandObserver& eye, const Bands& shape = {});

}  // namespace goniochrome::color
