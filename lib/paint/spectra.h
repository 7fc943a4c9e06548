// Paints in other light, from their spectra. goniochrome-color(7), "SPECTRA".
#pragma once

#include <optional>
#include <vector>

#include "base/result.h"
#include "color/color_difference.h"
#include "paint/paint.h"

namespace goniochrome::paint {

// The Lab of a spectrum under an illuminant for an observer, relative to the white of the same sum. Error: what is
// known.
Result<color::Lab> lab_of(const SpectrumReading& spectrum, const color::ViewingCondition& condition);

// The measurement with the rows of its spectra under a condition, in any of the names of color/illuminant.h; rows
// without a spectrum are left out. Error: it has no spectra, or the illuminant or observer is not known.
Result<Measurement> under_light(const Measurement& measurement, const color::ViewingCondition& stated);

// The paint under such a condition: rows from its spectra, and an appearance from these rows if it has one. Lobes and
// color map, which show the light before, are left out. A paint whose readings are for it stays as it is. Error: as
// under_light().
Result<Paint> in_light(Paint paint, const color::ViewingCondition& stated);

// A color difference at a geometry.
struct DifferenceAt {
  Geometry geometry;
  double value = 0;
};

// The usual formula of both functions below.
inline constexpr color::DifferenceFormula kInOtherLight{color::DifferenceFormula::Kind::kCiede2000};

// The color inconstancy of a paint by a formula, at each geometry of which it has a spectrum: how far the color under
// `test` seems to be from the color under `reference`, to an eye that has adapted to each. The color under `test`
// becomes its corresponding color by CMCCAT2000 with complete adaptation, as in CMCCON02 [Luo, Li, Hunt, Rigg and Smith
// 2003], and is the sample; the color under `reference` is the standard. A paint that reflects all wavelengths alike
// has 0. Error: as under_light().
Result<std::vector<DifferenceAt>> inconstancy(const Measurement& measurement, const color::ViewingCondition& reference,
                                              const color::ViewingCondition& test,
                                              const color::DifferenceFormula& formula = kInOtherLight);

// The special metamerism index for a change of illuminant (CIE 15:2004, 9.2.2.3) by a formula, at each geometry of
// which both have a spectrum: how much two paints that match under `reference` differ under `test`. If they do not
// quite match under `reference`, X, Y and Z of the sample under `test` are multiplied by the ratio that would make them
// match there, so that a pair with proportional spectra has 0. The index of a sample that has X, Y or Z of 0 under
// `reference` is NaN, unless the standard has 0 as well. Error: as under_light().
Result<std::vector<DifferenceAt>> metamerism(const Measurement& sample, const Measurement& standard,
                                             const color::ViewingCondition& reference,
                                             const color::ViewingCondition& test,
                                             const color::DifferenceFormula& formula = kInOtherLight);

// The spectrum of equal steps that has these factors, or nothing where the steps differ by more than 1e-6 of the first.
std::optional<SpectrumReading> spectrum_of(const Geometry& geometry, const std::vector<double>& wavelengths_nm,
                                           const std::vector<double>& factors);

}  // namespace goniochrome::paint
