// The lobes of exponents 0 and 1 of a lat-long map are sums along the part of every row that lies in a hemisphere.
// goniochrome-theory(7), PREFILTERING, Arcs.
#pragma once

#include <vector>

#include "envmap/environment.h"
#include "prefilter/internal/kernel.h"

namespace goniochrome::prefilter {

// The lobe at each of the directions, of the kernels of shape kStep and kCosine, of what `clip` leaves of a lat-long
// map. Along a row it is exact. Across a row it is summed at Gauss points, whose number follows from the tolerance;
// their error is far below it where no texel outshines the mean by more than BrightTexels leaves.
std::vector<Vec3> arc_sums(const envmap::Environment& env, const envmap::Clip& clip, const ZonalKernel& kernel,
                           const std::vector<Vec3>& directions, double tolerance);

// Gauss points across a row.
int arc_points(bool step, double tolerance);

}  // namespace goniochrome::prefilter
