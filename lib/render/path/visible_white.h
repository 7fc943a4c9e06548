// How bright white is in a scene that no environment and no directional light lights. goniochrome-paths(7), "Noise".
#pragma once

#include <cstdint>

#include "render/path/transport.h"
#include "render/path/visible_surface.h"

namespace goniochrome::render {

// The median, over some of the visible points, of the luminance that a matt white surface has there, with all that
// blocks light and all that passes it on. The points of parts that shine do not count: what a viewer takes for white is
// lit, and does not shine. 0 where nothing else is seen.
double visible_white(const Transport& transport, const Gbuffer& surface, int bounces, std::uint64_t seed);

}  // namespace goniochrome::render
