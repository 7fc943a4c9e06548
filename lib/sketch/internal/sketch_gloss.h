// Gloss from pictures: by the contrast of a highlight, and by its shape. [Shimizu2009] 3.5.3
// goniochrome-theory(7), SKETCH FITTING.
#pragma once

#include <optional>
#include <vector>

#include "color/color.h"

namespace goniochrome::sketch {

// How bright a color is on a display, 0..1: the sRGB signal of its luminance relative to display white.
double display_brightness(double luminance);

// Gloss units by contrast: (mean of the brightest tenth - mean of the darkest tenth)/0.5 * 100, at most 100; 0 for
// less than two values. Reorders its argument.
double contrast_gloss(std::vector<double>& brightness);

// A pixel of the highlight: how much brighter it is than the paint without gloss, relative to a white that faces the
// lamp.
struct HighlightSample {
  double aspecular_deg = 0, excess = 0;
};

// The reading of a 60 deg gloss meter on a gloss lobe that makes this highlight: cosine lobes of non-negative weight
// fitted to the robust mean excess of each half degree, put into the simulated meter. Nothing where no sample lies
// within 1.5 deg of specular, or nothing shines there.
std::optional<double> highlight_gloss(const std::vector<HighlightSample>& samples);

}  // namespace goniochrome::sketch
