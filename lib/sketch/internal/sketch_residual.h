// How far a picture is from the paint found, pixel by pixel and by angle. goniochrome-sketches(7), "SKETCH FITTING".
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "sketch/sketch.h"

namespace goniochrome::sketch {

// Fills rms_de76, median_de76 and the residual of `fit`, and its pixels where `all` are asked for. pair(i) is the i-th
// of the used pixels, which are places of the buffers. Without `all`, the figures come from some 20000 of them.
void take_residual(const image::AovFile& buffers, const std::vector<std::uint32_t>& used,
                   const std::function<PixelPair(std::size_t i)>& pair, bool all, SketchFit& fit);

}  // namespace goniochrome::sketch
