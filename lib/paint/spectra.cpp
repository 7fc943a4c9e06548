#include "paint/spectra.h"

#include <cmath>
#include <optional>

#include "color/spectrum.h"

namespace goniochrome::paint {

Result<color::Lab> lab_of(const SpectrumReading& spectrum, const color::ViewingCondition& condition) {
  std::vector<double> wavelengths_nm;
  for (std::size_t i = 0; i < spectrum.factors.size(); ++i)
    wavelengths_nm.push_back(spectrum.from_nm + spectrum.step_nm * static_cast<double>(i));
  GONIO_ASSIGN(const auto meter, color::SpectralColorimeter::make(wavelengths_nm, condition));
  return meter.lab(spectrum.factors);
}

Result<Measurement> under_light(const Measurement& measurement, const color::ViewingCondition& condition) {
  if (measurement.spectra.empty())
    return input_error("it has no spectra: its readings under {}/{} say nothing about {}/{}",
                       measurement.condition.illuminant, measurement.condition.observer_deg, condition.illuminant,
                       condition.observer_deg);
  Measurement result{condition, measurement.instrument, {}, measurement.spectra};
  for (const SpectrumReading& spectrum : measurement.spectra) {
    GONIO_ASSIGN(const color::Lab lab, lab_of(spectrum, condition));
    result.rows.push_back({spectrum.geometry, lab});
  }
  return Result(std::move(result));
}

std::optional<SpectrumReading> spectrum_of(const Geometry& geometry, const std::vector<double>& wavelengths_nm,
                                           const std::vector<double>& factors) {
  if (wavelengths_nm.size() < 2 || wavelengths_nm.size() != factors.size()) return std::nullopt;
  const double step = wavelengths_nm[1] - wavelengths_nm[0];
  for (std::size_t i = 0; i < wavelengths_nm.size(); ++i)
    if (std::abs(wavelengths_nm[i] - wavelengths_nm[0] - step * static_cast<double>(i)) > 1e-6 * step)
      return std::nullopt;
  return SpectrumReading{geometry, wavelengths_nm[0], step, factors};
}

}  // namespace goniochrome::paint
