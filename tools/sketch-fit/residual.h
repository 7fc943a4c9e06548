// The picture beside the paint that was found in it.
#pragma once

#include <string>

#include "base/result.h"
#include "sketch/sketch.h"

namespace goniochrome::tool {

// Writes a PNG of three panes of the buffers' size: the used pixels of the picture, of the paint found, and their
// differences, from black through red and yellow to white at 20 dE76. Pixels that were left out are dark blue, and what
// is not the mesh is gray. A scale stands at the lower left of the last pane.
Result<void> write_residual(const std::string& path, const image::AovFile& buffers, const sketch::SketchPixels& pixels,
                            const sketch::SketchFit& fit);

}  // namespace goniochrome::tool
