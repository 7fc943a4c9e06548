// How wide the highlight of a lamp is on a glossy paint, and which gloss makes it that wide.
// goniochrome-coats(7), "GLOSS".
#pragma once

#include "base/result.h"
#include "paint/paint.h"

namespace goniochrome::brdf {

// The reading of a gloss meter (GU) on the lobe whose highlight, under a lamp that spans `extent_deg`, falls to half
// its brightness at this aspecular angle (deg, 0..90). No lobe ends within the lamp: there the answer is the sharpest.
// Error: no meter has the angle meter_deg.
Result<double> gloss_of_edge(double edge_deg, double meter_deg, double extent_deg);

// The aspecular angle (deg, 0..90) at which the highlight of this paint, of its gloss lobes and its mirror together,
// falls to half its brightness under a lamp that spans `extent_deg` (above 0). 0 for a paint without gloss.
double highlight_edge_deg(const paint::LobeFit& fit, double extent_deg);

}  // namespace goniochrome::brdf
