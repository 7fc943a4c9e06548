// Lobes that stand for a rough coat where prefiltered maps are looked up. At oblique views the light of the coat is
// wider in the plane of incidence than across it, which several cosine lobes show whose axes are tilted in that plane.
// goniochrome-coats(7), "What maps draw".
#pragma once

#include <vector>

#include "brdf/rough_coat.h"
#include "paint/paint.h"

namespace goniochrome::brdf {

// A set of lobes of these exponents (ascending, finite) for a coat of that refractive index, at kCoatViews_deg. K_D is
// 0. Of the light of each view, the share of even light in `mirrored` is drawn by a mirror and is not the lobes' to
// show; it has an element for each view.
paint::TiltedLobes coat_tilts(const RoughCoat& coat, double index, const std::vector<double>& exponents,
                              const std::vector<double>& mirrored);

}  // namespace goniochrome::brdf
