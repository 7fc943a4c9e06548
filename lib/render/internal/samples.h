// The samples of all pixels as an engine shades them, with what is added to them on the processor.
#pragma once

#include <array>

#include "render/engine.h"

namespace goniochrome::render {

// Makes the picture the mean of `count` samples from `first` on, with the surface layer and the mirror images of lamps.
// What lies behind panes is not in it.
Result<void> take_samples(Sight& sight, Engine& engine, const Scene& scene, const Effects& effects, int first,
                          int count, image::Image& picture);

// Where a sample of a pixel lies, from the center of the pixel: 0 is the center itself; then come the samples.
std::array<double, 2> shift_of(int sample, int samples);

// From a sample to the middle of the part of its pixel that it stands for, one of as many squares as there are samples.
std::array<double, 2> to_middle_of_part(int sample, int samples);

}  // namespace goniochrome::render
