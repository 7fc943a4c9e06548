// Paints in other light, from their spectra. goniochrome-theory(7), SPECTRA.
#pragma once

#include <optional>
#include <vector>

#include "base/result.h"
#include "paint/paint.h"

namespace goniochrome::paint {

// The Lab of a spectrum under an illuminant for an observer, relative to the white of the same sum. Error: what is
// known.
Result<color::Lab> lab_of(const SpectrumReading& spectrum, const color::ViewingCondition& condition);

// The measurement with the rows of its spectra under `condition`; rows without a spectrum are left out. Error: it has
// no spectra, or the illuminant or observer is not known.
Result<Measurement> under_light(const Measurement& measurement, const color::ViewingCondition& condition);

// The spectrum of equal steps that has these factors, or nothing where the steps differ by more than 1e-6 of the first.
std::optional<SpectrumReading> spectrum_of(const Geometry& geometry, const std::vector<double>& wavelengths_nm,
                                           const std::vector<double>& factors);

}  // namespace goniochrome::paint
