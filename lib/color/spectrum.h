// Turns spectral reflectance into color by the CIE's tables of illuminants and observers.
// goniochrome-color(7), "SPECTRA".
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "color/color.h"

namespace goniochrome::color {

// The illuminants under which spectra are integrated, for help and messages: "D65, D50, ... or ID65".
std::string spectral_illuminants();

// The relative power of such an illuminant at a wavelength of 360 to 780 nm: along straight lines between the values of
// the table. Error: the names.
Result<double> illuminant_power(double nm, const std::string& name);

// The Lagrange cubic through four of the values, and outside of the wavelengths the outermost value. The wavelengths
// ascend, and there are at least two.
double interpolated(std::span<const double> wavelengths_nm, std::span<const double> values, double nm);

// The largest share (0..1) of X, Y or Z that may come from wavelengths beyond the measured ones, and the share from
// which on it is told. From 400 to 700 nm less than 0.003 lies beyond, from 430 to 700 nm about 0.15.
constexpr double kMostHeldShare = 0.2, kToldHeldShare = 0.01;

// Turns reflectance factors at fixed wavelengths into XYZ and Lab under one viewing condition. Lab is relative to the
// white that the perfect diffuser has in the same sum, so it needs no second table.
class SpectralColorimeter {
 public:
  // `wavelengths_nm` ascend, and there are at least two. Error: they are not like that, they leave out more than
  // kMostHeldShare of what the observer sees, or the condition, in any of the names of color/illuminant.h, is not known
  // (the message says what is known).
  static Result<SpectralColorimeter> make(std::span<const double> wavelengths_nm, const ViewingCondition& stated);

  // XYZ of a reflectance factor per wavelength; Y = 1 for the perfect diffuser. Values may be negative or above 1.
  Xyz xyz(std::span<const double> reflectance) const;
  Lab lab(std::span<const double> reflectance) const { return lab_from_xyz(xyz(reflectance), white_); }

  // The illuminant's own XYZ by the same sum, Y = 1.
  const Xyz& white() const { return white_; }

  // The largest share (0..1) of X, Y or Z that comes from wavelengths beyond the measured ones, where the outermost
  // value is held.
  double held_share() const { return held_share_; }

 private:
  std::vector<std::array<double, 3>> weights_;  // one triple per wavelength
  Xyz white_;
  double held_share_ = 0;
};

}  // namespace goniochrome::color
