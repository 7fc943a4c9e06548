// The samples of all pixels as an engine shades them, with what is added to them on the processor.
#pragma once

#include "render/engine.h"

namespace goniochrome::render {

// Makes the picture the mean of `count` samples from `first` on, with the surface layer and the mirror images of lamps.
// What lies behind panes is not in it.
Result<void> take_samples(Sight& sight, Engine& engine, const Scene& scene, const Effects& effects, int first,
                          int count, image::Image& picture);

}  // namespace goniochrome::render
