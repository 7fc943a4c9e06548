// The integral of a kernel over a part of a texel, which every method of this room means: each texel is a patch of
// constant radiance. goniochrome-prefiltering(7), "The reference".
#pragma once

#include "envmap/patch.h"
#include "prefilter/internal/kernel.h"

namespace goniochrome::prefilter {

// The integral of K(angle between d and w) dw over the cell, in sr, to about `relative` of itself: by Gauss points
// where the kernel is smooth over the cell, by quarters where it is narrower than the cell. A cell that the kernel's
// edge cuts is taken to about `at_edge` of itself, in pieces on which the cosine is linear.
double lobe_over_cell(const envmap::Environment& env, const envmap::Cell& cell, const Vec3& d,
                      const ZonalKernel& kernel, double relative, double at_edge);

// Variant for a whole texel of a lat-long map under max(0, cos)^E of a large exponent, the width of which is 1/sqrt(E).
double sharp_lobe_over_texel(const envmap::Environment& env, int column, int row, const Vec3& d, double exponent,
                             double relative);

}  // namespace goniochrome::prefilter
