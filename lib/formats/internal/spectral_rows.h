// Parts that tables of spectra share: wavelengths in headings, reflectances that are factors or percent, and the colors
// of the same row.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "color/color.h"
#include "color/spectrum.h"
#include "formats/imported.h"
#include "paint/paint.h"

namespace goniochrome::formats {

struct WavelengthColumn {
  double nm = 0;
  int at = 0;  // the column
};

// The wavelengths that spectra of a surface's color have.
constexpr double kFirstSpectral_nm = 300, kLastSpectral_nm = 1100;

// A table of reflectances has this many columns of wavelengths, or more.
constexpr std::size_t kFewestWavelengths = 5;

// The wavelength, 300 to 1100 nm, that a heading such as `400`, `400 nm`, `R400 [%]` or `SPECTRAL_NM_400` names;
// nothing for any other heading.
std::optional<double> wavelength_in(std::string_view heading);

// The scale of reflectances that a heading or a unit (`400 nm (%)`, `percent`, `[%]`, `factor`) states.
Scale scale_in(std::string_view text);

// Takes what a text states, if it states a scale, into `scale`. Error: that is another one.
Result<void> take_scale(std::string_view text, Scale& scale);

// Error: a factor is -0.1 or less.
Result<void> check_not_negative(const std::vector<double>& factors);

// Sorts the columns by their wavelengths. Error: a wavelength stands twice, or the steps are not equal.
Result<void> sort_wavelengths(std::vector<WavelengthColumn>& columns);

// Finds the scale of a file's reflectances from all of its readings together. A single value tells nothing: 2 is a dark
// paint in percent, and the gloss of a bright one in factors. goniochrome-paint(5), "REFLECTANCES".
class ScaleJudge {
 public:
  // A reading of a paint: its values, and L* where the file states it beside them. The readings of a paint stand
  // together.
  void add(std::string_view paint, const paint::Geometry& geometry, const std::vector<double>& values,
           std::optional<double> L);

  // The unit that makes factors of the values: 1, or 0.01 for percent. `stated` is what the file says. Where it says
  // nothing, the option holds, and then the L* beside the values or, without any, what paints can reflect. `remarks`
  // hears what was assumed. Error: the values make no sense on the scale that holds, or on neither scale, or on both.
  Result<double> unit(Scale stated, Scale option, Remarks& remarks);

  // A scale that `format` defines holds as long as the values can be of it.
  Result<double> unit_of_format(const std::string& format, Scale defined, Scale option, Remarks& remarks);

  // Error: factors that a file states by the value of white cannot be.
  Result<double> unit_of_norm();

 private:
  // The brightest readings of a paint, near to specular and farther away.
  struct Brightest {
    double near = 0, far = 0;
    std::string near_at, far_at;
    bool beyond = false;  // one is brighter than light that is reflected about specular can be
    std::string beyond_at;
  };
  void close_paint();
  void note_dark(Remarks& remarks) const;
  bool is_told_by_lab() const { return as_factor_ != as_percent_; }
  Result<double> checked(Scale scale, const std::string& whose, const std::string& remedy);

  std::string paint_;
  Brightest open_;
  std::size_t paints_ = 0, impossible_ = 0;  // as factors
  std::size_t dark_ = 0;                     // paints that as percent reflect at most kDarkPercent at every angle
  double brightest_ = 0;                     // mean of a spectrum
  std::string first_impossible_;             // paint, geometry and value
  std::string first_bright_;                 // likewise, of a paint that may be either
  std::string first_dark_;
  double as_factor_ = 0, as_percent_ = 0;  // how far the values lie from the L* beside them
};

// Scales the XYZ of a file to 0 to 1; formats define it from 0 to 100. Where a file has no spectra that
// --scale could speak of, it speaks of XYZ. It remarks at the end where no Y is so large that its scale shows.
class XyzScale {
 public:
  void set(Scale option, bool has_spectra);
  color::Xyz scaled(const color::Xyz& xyz);
  void finish(Remarks& remarks) const;

 private:
  double white_ = 100, brightest_ = 0;
  bool is_given_ = false;
};

// Integrates spectra, most of which have the wavelengths and the light of the one before.
class SpectralMeter {
 public:
  // The color of a spectrum whose values are multiplied by `unit`. Error: the light is not known, and what is.
  Result<color::Lab> lab(const paint::SpectrumReading& spectrum, const color::ViewingCondition& condition,
                         double unit = 1);

  // The part of X, Y or Z that the last spectrum of lab() does not cover; see color/spectrum.h.
  double held_share() const { return meter_ ? meter_->held_share() : 0; }

 private:
  std::optional<color::SpectralColorimeter> meter_;
  color::ViewingCondition condition_{"", 0};
  double from_nm_ = 0, step_nm_ = 0;
  std::vector<double> factors_;
};

// A dark paint may read a little below 0 for the noise of the instrument; CxF3 allows no factor of -0.1 or less.
constexpr double kSmallestFactor = -0.1;
// No instrument reads a larger value, in percent or as a factor.
constexpr double kLargestReflectance = 2000;

// Remarks that a spectrum is kept or integrated whose wavelengths leave out a part of what the observer sees.
void note_uncovered(double held_share, std::string_view example, Remarks& remarks);

}  // namespace goniochrome::formats
