// Differences between radiances are measured as a viewer sees them who takes the diffuse white of the scene for white.
#pragma once

#include <vector>

#include "color/color.h"

namespace goniochrome::render {

// CIEDE2000 of two radiances, as Lab relative to D65 of that luminance; 1 where that is not above 0, as in the dark,
// where all is black.
double seen_difference(const color::Rgb& a, const color::Rgb& b, double white_luminance);

// The smallest value that 95 % of them do not exceed; 0 of none.
double percentile_95(std::vector<double> values);

}  // namespace goniochrome::render
