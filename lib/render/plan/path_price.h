// How long the engine path takes for a frame, told from some of its pixels. goniochrome-theory(7), PLAN, The whole.
#pragma once

#include <cstdint>
#include <vector>

#include "render/plan.h"

namespace goniochrome::render {

// What the engine would draw: some pixels that show the mesh, some that show the floor, and how many there are of each
// in a frame.
struct PathWork {
  std::vector<ProbePixel> mesh, floor;
  double mesh_pixels = 0, floor_pixels = 0;
  int pixel_samples = 1;
  double white_luminance = 1, tolerance_de00 = 0.5;
  int bounces = 8;
  std::uint64_t seed = 1;
};

struct PathPrice {
  double samples = 0;  // the mean over all pixels of both kinds
  double ms = 0;       // on all cores together, until the noise is within the tolerance
};

// `transport` is that of the engine. The engine itself draws small windows about these pixels in few samples: their
// noise tells how many each pixel needs, and their time what those take. 0 where there are no pixels. All but the time
// is bit-identical for any number of threads.
PathPrice path_price(const Transport& transport, const PathWork& work);

}  // namespace goniochrome::render
