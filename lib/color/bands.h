// Light and reflectance in 31 bands of wavelength, 400 to 700 nm by 10. goniochrome-color(7), "LIGHT IN BANDS".
#pragma once

#include <array>
#include <span>
#include <string>

#include "base/result.h"
#include "color/color.h"

namespace goniochrome::color {

constexpr int kBands = 31;
constexpr double kFirstBand_nm = 400, kBandStep_nm = 10;

// One value for each band: a reflectance (factor), or light relative to daylight D65 of luminance 1, whose bands are
// all 1.
using Bands = std::array<double, kBands>;

constexpr double band_nm(int band) {
  return kFirstBand_nm + kBandStep_nm * band;
}

Bands even_bands(double value);
double mean(const Bands& bands);
Bands scaled(double factor, const Bands& bands);
Bands product(const Bands& x, const Bands& y);  // band by band

// A reflectance in bands: the Lagrange cubic through the values at the wavelengths, not below 0 and, outside of them,
// the outermost value (as SpectralColorimeter has it). Error: fewer than two wavelengths, they do not ascend, or they
// leave out too much of what the observer sees.
Result<Bands> reflectance_bands(std::span<const double> wavelengths_nm, std::span<const double> values);

// Relative spectral power in bands: the power within each band, weighed as a triangle that reaches to the neighboring
// bands, over that of D65; scaled to luminance 1 for the standard observer of 2 deg. Power is linear between its
// wavelengths. Error: fewer than two wavelengths, they do not ascend or do not cover 400 to 700 nm, a negative power,
// or no light at all.
Result<Bands> light_bands(std::span<const double> wavelengths_nm, std::span<const double> power);

// The light of an illuminant that spectral_illuminants() names. Error: the names.
Result<Bands> illuminant_bands(const std::string& name);

// An eye: what bands look like.
class BandObserver {
 public:
  // Error: the standard observers are 2 and 10 deg.
  static Result<BandObserver> make(int observer_deg = 2);

  int observer_deg() const { return observer_deg_; }
  // The color in the working space of light relative to daylight, which has 1,1,1, or of a reflectance in daylight. No
  // other adaptation takes place.
  Rgb rgb(const Bands& relative) const;
  // Its linear weights: the color of each band by itself.
  const std::array<Rgb, kBands>& weights() const { return weights_; }

 private:
  int observer_deg_ = 2;
  std::array<Rgb, kBands> weights_{};
};

}  // namespace goniochrome::color
