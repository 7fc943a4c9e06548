// Which colors of a paint found the picture tells, and which it leaves open. goniochrome-theory(7), SKETCH FITTING.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sketch/internal/sketch_lobes.h"
#include "sketch/sketch.h"

namespace goniochrome::sketch {

// Reads the rows off the lobes that were found where they are told (is_told, by the aspecular angle) and differ from
// the rows of face, flop and travel: the picture shows the lobes, which a curve of few numbers misses where the paint
// does not follow one. Where such a paint explains the picture to rounding, no angle is to be told. Adds the rows of
// export angles that the paint found has no reading for.
void take_shown(const formats::Basis& basis, const PaintWeights& weights, double coat_index,
                const std::function<bool(double angle_deg)>& is_told, SketchFit& fit);

// Adds to fit.unsure the angles whose color is another one in lobes that explain the pixels as well, with other gloss:
// `found` and `others` are fitted to the same samples.
void take_open_by_gloss(const formats::Basis& basis, const FreeLobes& found, const std::vector<FreeLobes>& others,
                        double coat_index, SketchFit& fit);

// A pixel under a lamp, and how far it is from the paint found (CIE 1976).
struct TrustPixel {
  double aspecular_deg = 0, de76 = 0;
};

// Some pixels about each export angle. `difference` is how far a used pixel is, by its number among these.
std::vector<TrustPixel> trust_pixels(const SketchInput& input, const SketchPixels& pixels,
                                     const std::function<double(std::size_t)>& difference);

// Adds to fit.unsure the angles that too few of the pixels show as the paint found has them.
void take_thinly_seen(const std::vector<TrustPixel>& pixels, SketchFit& fit);

}  // namespace goniochrome::sketch
