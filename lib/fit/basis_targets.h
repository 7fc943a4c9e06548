// Paints as the search for a basis sees them. goniochrome-theory(7), CHOOSING
// THE BASIS.
#pragma once

#include "base/result.h"
#include "fit/basis_search.h"
#include "fit/internal/brdf_target.h"
#include "paint/curve.h"
#include "paint/paint.h"

namespace goniochrome::fit {

struct BasisTargetOptions {
  paint::TargetCurve::Kind target = paint::TargetCurve::Kind::kMeasured;
  int angles = 40;                 // sample angles, evenly from the first known angle to the last
  bool perceptual_weights = true;  // rows weighted by dL*/dY, as fit-paint does
};

// The reflectance factors of a paint at evenly spaced aspecular angles. Error:
// the paint has no rows beyond glare and no appearance, or its illuminant is
// unknown.
Result<BasisTarget> basis_target(const paint::Paint& paint, const BasisTargetOptions& options);

// The same for a measured BRDF: means over all directions to 75 deg from the normal, in steps of 2.5 deg of the
// aspecular angle from 10 to 110. Error: fewer than two steps hold a direction.
Result<BasisTarget> basis_target(const BrdfTarget& brdf, const BasisTargetOptions& options);

// The largest dE00 over the sample angles between a target and its best fit
// with these exponents.
double basis_de00(const std::vector<double>& exponents, const BasisTarget& target);

}  // namespace goniochrome::fit
