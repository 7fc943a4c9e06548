// The picture of what a fit leaves.
#pragma once

#include <string>

#include "base/result.h"
#include "sketch/sketch.h"

namespace goniochrome::tool {

// A PNG of the buffers' size: differences from black through red and yellow to white at 20 dE76, pixels left out in
// dark blue, what is not the mesh in gray, with a scale at the lower left.
Result<void> write_residual(const std::string& path, const image::AovFile& buffers, const sketch::SketchPixels& pixels,
                            const sketch::SketchFit& fit);

}  // namespace goniochrome::tool
