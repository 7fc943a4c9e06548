// The result of a dropper for the pixels below it, wherever these come from. [Shimizu2009] 3.5.2, 3.5.3;
// goniochrome-sketches(7), "MOOD BOARDS".
#pragma once

#include <vector>

#include "color/color.h"

namespace goniochrome::sketch {

// Gloss units by the contrast of display signals (0..1): (mean of the brightest tenth - mean of the darkest tenth)/0.5
// * 100, at most 100; 0 for less than two values. Reorders its argument.
double contrast_gloss(std::vector<double>& brightness);

// The mean light of pixels, its color where white and even light fell on them, and their gloss by contrast.
struct DropperColor {
  color::Rgb mean;
  color::Lab lab;
  double gloss = 0;
};
// `lights` are linear in the working space, where 1 is the white of the display; at least one.
DropperColor dropper_color(const std::vector<color::Rgb>& lights);

// The light of a pixel of an sRGB picture, from its signals 0..1.
color::Rgb light_of_srgb(double r, double g, double b);

}  // namespace goniochrome::sketch
