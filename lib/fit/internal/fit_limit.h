// Why a fit cannot come closer. Internal to lib/fit.
#pragma once

#include <string>
#include <vector>

#include "fit/paint_fit.h"

namespace goniochrome::fit {

// What limits the worst reading of a fit, in words: its color is outside the working space, its twin on the other side
// of specular has another color (of a fit for all views), a channel grows away from specular; or else the exponents of
// the basis. `errors` are those of the readings, in their order; at least one.
std::string fit_limit(const std::vector<paint::LabReading>& readings, const std::vector<GeometryError>& errors,
                      const color::Xyz& white, bool by_view);

}  // namespace goniochrome::fit
