// The samples of all pixels as an engine shades them, with what is added to them on the processor.
#pragma once

#include <array>

#include "render/engine.h"

namespace goniochrome::render {

// Makes the picture the mean of `count` samples from `first` on, with the surface layer and the mirror images of lamps.
// What lies behind panes is not in it.
Result<void> take_samples(Sight& sight, Engine& engine, const Scene& scene, const Effects& effects, int first,
                          int count, image::Image& picture);

// Pixels whose center is shaded: those at no edge, which it may stand for, and those beside them, by which it is seen
// how the picture bends there.
PixelFlags wanted_centers(const PixelFlags& edges, const Gbuffer& centers);

// Pixels of which the center does not tell the mean over the pixel, within a small part of the tolerance: those at
// edges, and those where the picture of the centers bends too much.
PixelFlags wanted_pixels(const PixelFlags& edges, const image::Image& centers, double white_luminance,
                         double tolerance_de00);

// Puts the pixels of `closer` that are wanted into the picture.
void put_wanted(const PixelFlags& wanted, const image::Image& closer, image::Image& picture);

// From a sample, 0 being the center of the pixel, to the middle of the part of its pixel that it stands for, one of as
// many squares as there are samples.
std::array<double, 2> to_middle_of_part(int sample, int samples);

}  // namespace goniochrome::render
