// The mirror lobe: the environment itself as a cube, each texel the mean radiance over it.
// goniochrome-theory(7), PREFILTERING, The mirror.
#pragma once

#include "envmap/cube_map.h"
#include "envmap/environment.h"

namespace goniochrome {

// A cube of size n whose texels hold the mean of the environment over their solid angle, by exact overlaps with the
// environment's texels, so that neither flux nor a sun between sample points is lost.
CubeMap mirror_map(const Environment& env, int n);

}  // namespace goniochrome
