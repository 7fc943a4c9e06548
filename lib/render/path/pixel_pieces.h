// Pixels whose samples all show one piece of surface, and what follows from it: such a pixel needs fewer samples than
// one at an edge, and pixels beside each other on one piece tell each other's light.
// goniochrome-paths(7), "RECONSTRUCTION".
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/path/transport.h"
#include "render/path/visible_surface.h"

namespace goniochrome::render {

// The G-buffers of the samples of all pixels, with triangles: at most 16.
using PixelSamples = std::span<const Gbuffer* const>;

// Which samples meet the scene or its floor.
Coverage coverage(PixelSamples samples);

// Pixels whose samples all show one part, and normals with at least this cosine to that of the first.
PixelFlags even_pixels(PixelSamples samples, float cosine);
// The distance of pixels that are sampled first, a power of two: at least `least` of so many points are left.
int first_spacing(std::size_t points, std::size_t least);
// The least number, unless another is asked for.
constexpr std::size_t kFirstPoints = 25000;

// Even pixels that a first round leaves out, because the pixel at the corner of their square of so many pixels is even
// too and shows the same flat piece.
PixelFlags told_by_corners(const Gbuffer& gbuffer, const PixelFlags& even, int spacing);

}  // namespace goniochrome::render
