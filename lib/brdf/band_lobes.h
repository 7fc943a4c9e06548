// The lobes of a fitted paint in bands of wavelength, from the spectra that it keeps.
// goniochrome-color(7), "LIGHT IN BANDS".
#pragma once

#include "base/result.h"
#include "color/bands.h"
#include "paint/band_lobes.h"
#include "paint/paint.h"

namespace goniochrome::brdf {

// Colored weights of a paint without a spectrum are an error, or take the smoothest spectrum of their color.
enum class NoSpectrum { kRefused, kGuessed };

// The weights of `paint.lobes` in bands. They have the color of the weights in three channels and, of all such, are
// nearest in shape to the weights that meet the paint's spectra best, by least squares in each band; what its readings
// do not tell are mixtures of its spectra. Gray weights are even over all bands, which asks for no spectrum. Error: no
// lobes; a color map, which has no spectra; where they are refused, colored weights without a spectrum, or colored
// gloss, which no spectrum tells of.
Result<paint::BandLobes> band_lobes(const paint::Paint& paint, const color::BandObserver& eye,
                                    NoSpectrum otherwise = NoSpectrum::kRefused);

}  // namespace goniochrome::brdf
