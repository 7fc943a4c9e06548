// What tables of spectra share: wavelengths in headings, reflectances that are factors or percent, and the colors that
// stand beside them.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "color/spectrum.h"
#include "paint/paint.h"

namespace goniochrome::formats {

struct WavelengthColumn {
  double nm = 0;
  int at = 0;  // the column
};

// A table of reflectances has this many columns of wavelengths, or more.
constexpr std::size_t kFewestWavelengths = 5;

// The wavelength, 300 to 1100 nm, that a heading such as `400`, `400 nm`, `R400` or `SPECTRAL_NM_400` names; nothing
// for any other heading.
std::optional<double> wavelength_in(std::string_view heading);

// Error: a factor is -0.1 or less.
Result<void> check_not_negative(const std::vector<double>& factors);

// Error: the wavelengths do not ascend in equal steps.
Result<void> check_steps(const std::vector<WavelengthColumn>& columns);

// Integrates spectra, most of which have the wavelengths and the light of the one before.
class SpectralMeter {
 public:
  // The color of a spectrum whose values are multiplied by `unit`. Error: the light is not known, and what is.
  Result<color::Lab> lab(const paint::SpectrumReading& spectrum, const color::ViewingCondition& condition,
                         double unit = 1);

  // Turns percent into factors (1 = perfect diffuser) where the L* beside the spectrum says that they are percent.
  // Error: there is no L*, and a value is above 20, which no paint reflects; a factor is -0.1 or less.
  Result<void> make_factors(paint::SpectrumReading& spectrum, const color::ViewingCondition& condition,
                            std::optional<double> L);

 private:
  std::optional<color::SpectralColorimeter> meter_;
  color::ViewingCondition condition_{"", 0};
  double from_nm_ = 0, step_nm_ = 0;
  std::vector<double> factors_;
};

// A metallic paint reflects up to ten times what a white diffuser does. A dark one may read a little below 0 for the
// noise of the instrument; CxF3 allows no factor of -0.1 or less.
constexpr double kLargestFactor = 20, kSmallestFactor = -0.1;

}  // namespace goniochrome::formats
