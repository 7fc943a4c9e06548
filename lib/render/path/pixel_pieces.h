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

// One flag for each pixel.
using PixelFlags = std::vector<std::uint8_t>;

// Which samples meet the scene or its floor.
Coverage coverage(PixelSamples samples);

// Pixels whose samples all show one piece, by part and normal.
PixelFlags even_pixels(PixelSamples samples);

// The distance of pixels that are sampled first, a power of two: at least `least` of so many points are left.
int first_spacing(std::size_t points, std::size_t least);
// The least number, unless another is asked for.
constexpr std::size_t kFirstPoints = 50000;

// Even pixels that a first round leaves out, because the pixel at the corner of their square of so many pixels is even
// too and shows the same piece at nearly the same normal.
PixelFlags told_by_corners(const Gbuffer& gbuffer, const PixelFlags& even, int spacing);

// A point that gets less than this part of even light (Transport::open_share) is corrected by the sum of all that is
// left instead of what is taken: where most is taken, that has less noise.
constexpr double kMostlyHidden = 0.5;

// Pixels of the mesh that are so hidden, by their first sample. Both sums have the same mean, so that one pixel decides
// for others beside it on its part. Where a pane is seen, the picture has what is behind as well, and no pixel is
// hidden.
PixelFlags hidden_pixels(const Transport& transport, PixelSamples samples);

}  // namespace goniochrome::render
