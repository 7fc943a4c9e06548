// The picture of the differences that a fit leaves.
#pragma once

#include <string>

#include "base/result.h"
#include "sketch/sketch.h"

namespace goniochrome::tool {

// Writes a PNG of the buffers' size. Differences go from black through red and yellow to white at 20 dE76. Pixels that
// were left out are dark blue, and what is not the mesh is gray. A scale stands at the lower left.
Result<void> write_residual(const std::string& path, const image::AovFile& buffers, const sketch::SketchPixels& pixels,
                            const sketch::SketchFit& fit);

}  // namespace goniochrome::tool
