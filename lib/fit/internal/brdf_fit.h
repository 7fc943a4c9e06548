// The rows of a measured BRDF's fit, and how well it was met. Internal to lib/fit.
// goniochrome-theory(7), FITTING.
#pragma once

#include <vector>

#include "fit/internal/brdf_target.h"
#include "fit/internal/flake_fit.h"
#include "fit/paint_fit.h"

namespace goniochrome::fit {

struct BrdfRows {
  FlakeTarget flake;               // the directions that are fitted
  std::vector<BrdfSample> fitted;  // the same as measured
  std::vector<BrdfSample> glare;   // within kGlareAngle_deg of specular
  std::size_t steep = 0;           // left out for being near grazing
  double first_rad = 0;            // the smallest aspecular angle fitted
  double gamut_de00 = 0;           // the largest color change from setting negative channels to 0
};

// Error: no direction is left beyond glare and not steeper than the options say.
Result<BrdfRows> brdf_rows(const BrdfTarget& brdf, const color::Xyz& white, const FitOptions& options,
                           const std::vector<double>& exponents);

// How lobes predict directions that they were not fitted to.
FiveAngleFigures five_angle_figures(const BrdfTarget& brdf, const paint::LobeFit& lobes);

// Fills in the errors over the fitted directions.
void compare(const BrdfRows& rows, const color::Xyz& white, PaintFit& fit);

}  // namespace goniochrome::fit
