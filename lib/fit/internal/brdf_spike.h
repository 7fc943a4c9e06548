// What a measured BRDF shows near specular beside its flake: the spike of the clear coat and the sharp part of the
// flake highlight. Internal to lib/fit. goniochrome-theory(7), FITTING.
#pragma once

#include "fit/internal/brdf_rows.h"

namespace goniochrome::fit {

// Adds to the sharp lobes, by least squares on what the flake leaves within glare and around it: K_G, gray and with the
// Fresnel reflectance of a coat, and where `flake_too`, K_DD of those exponents, in color and without. Only directions
// at different incidence tell the two apart. Sets the albedo of the coat.
void add_spike(const BrdfRows& rows, const std::vector<double>& flake_too, PaintFit& fit);

// What the lobes show there, gloss included: reflectance factors of the working space.
color::Rgb shown_at(const paint::LobeFit& lobes, const BrdfSample& sample);

}  // namespace goniochrome::fit
