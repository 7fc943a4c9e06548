// The lobes of a paint in bands of wavelength. goniochrome-color(7), "LIGHT IN BANDS".
#pragma once

#include <vector>

#include "color/bands.h"
#include "paint/paint.h"

namespace goniochrome::paint {

// The weights at one angle of the viewer from the normal, as ViewLobes has them for three channels.
struct BandWeights {
  double view_deg = 0;
  color::Bands diffuse{};                                // K_D, 1/sr
  std::vector<color::Bands> directional_diffuse, gloss;  // K_DD and K_G of each exponent, 1/sr
  color::Bands mirror{};                                 // weight times Fresnel
};

struct BandLobes {
  double coat_index = kNoCoat;
  std::vector<double> exponents;   // finite, ascending; each has a weight above 0 in some band of some view
  std::vector<BandWeights> views;  // one, or ascending in view_deg
  double misfit_de00 = 0;          // how far the weights are from the weights of the three channels, in daylight
  std::vector<double> readings_de00 = {};  // how far they are from the spectra, for each, under illuminant A
};

// The paint with the mean over the bands in each channel.
LobeFit mean_lobes(const BandLobes& bands);

}  // namespace goniochrome::paint
