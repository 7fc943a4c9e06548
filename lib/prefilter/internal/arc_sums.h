// The lobes of exponents 0 and 1 of a lat-long map by sums along the part of every row that a hemisphere sees.
// goniochrome-theory(7), PREFILTERING, Arcs.
#pragma once

#include <vector>

#include "envmap/environment.h"
#include "prefilter/internal/kernel.h"

namespace goniochrome::prefilter {

// P_E at each of the directions, E = 0 or 1, of what `clip` leaves of a lat-long map. Along a row it is exact; across a
// row it is summed at Gauss points, whose number follows from the tolerance: what a row bends there is far below it
// where no texel outshines the mean by more than BrightTexels leaves.
std::vector<Vec3> arc_sums(const envmap::Environment& env, const envmap::Clip& clip, const ZonalKernel& kernel,
                           const std::vector<Vec3>& directions, double tolerance);

// Gauss points across a row.
int arc_points(bool step, double tolerance);

}  // namespace goniochrome::prefilter
