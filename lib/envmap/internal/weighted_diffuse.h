// The diffuse map of a surface that takes in another share of light from each direction.
// goniochrome-rendering(7), "Coat in image light".
#pragma once

#include <functional>

#include "envmap/prefiltered.h"

namespace goniochrome::envmap {

// The integral of L(w) T(n.w) n.w over the hemisphere about n, over that of T(n.w) n.w, for `share` = T (above 0 but at
// grazing, smooth): a constant environment stays itself. It is the diffuse map times the ratio of two sums over the
// mirror part or, where there is none, over the sharpest lobe, on a grid of 16 texels a face; T changes little within
// such a texel. The diffuse map itself where no lobe is sharp enough.
CubeMap weighted_diffuse(const PrefilteredEnvironment& env, const std::function<double(double)>& share);

}  // namespace goniochrome::envmap
