// The gloss of paint in a picture: by the contrast of a highlight, and by its shape. [Shimizu2009] 3.5.3
// goniochrome-sketches(7), "SKETCH FITTING".
#pragma once

#include <optional>
#include <vector>

#include "sketch/dropper.h"

namespace goniochrome::sketch {

// A pixel of the highlight: how much brighter it is than the paint without gloss, relative to a white that faces the
// lamp.
struct HighlightSample {
  double aspecular_deg = 0, excess = 0;
};

// The reading of a simulated 60 deg gloss meter on lobes that make this highlight: cosine lobes of non-negative weight,
// fitted to the median excess of each half degree. Empty where no sample lies within 1.5 deg of specular, or where
// nothing shines there.
std::optional<double> highlight_gloss(const std::vector<HighlightSample>& samples);

}  // namespace goniochrome::sketch
