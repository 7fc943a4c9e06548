// The fit of a measured BRDF: which directions its flake is fitted to, the spike that is left near specular, and how
// well all directions are met. goniochrome-fitting(7), "FITTING".
#pragma once

#include <vector>

#include "fit/brdf_target.h"
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

// Sorts the directions of a measured BRDF. Error: no direction is left beyond glare and not steeper than the options
// say.
Result<BrdfRows> brdf_rows(const BrdfTarget& brdf, const color::Xyz& white, const FitOptions& options,
                           const std::vector<double>& exponents);

// Adds to the sharp lobes what the flake leaves within glare and around it, by least squares: K_G, gray and with the
// Fresnel reflectance of a coat, and K_DD of the exponents in `flake_too`, in color and without that reflectance. Only
// directions at different incidence tell the two apart. Sets the albedo of the coat in the report.
void add_spike(const BrdfRows& rows, const std::vector<double>& flake_too, PaintFit& fit);

// Fills in the errors over the fitted directions.
void compare(const BrdfRows& rows, const color::Xyz& white, PaintFit& fit);

// How lobes predict directions that they were not fitted to.
FiveAngleFigures five_angle_figures(const BrdfTarget& brdf, const paint::LobeFit& lobes);

}  // namespace goniochrome::fit
