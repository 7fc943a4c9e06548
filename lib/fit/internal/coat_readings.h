// The flake part of a fit under a clear coat: readings that the lobes meet without the coat are met under it too, as
// far as weights >= 0 can. goniochrome-fitting(7), "FITTING".
#pragma once

#include <vector>

#include "fit/internal/flake_fit.h"

namespace goniochrome::fit {

// A row whose reflectance factor is this close to its value in each channel is met. The l1 fit meets a row to some
// 1e-15 or leaves at least 1e-5, as files state Lab values to three digits at best.
constexpr double kMet = 1e-9;

struct CoatedFit {
  FlakeFit fit;
  std::vector<FlakePoint> lost;  // of the known rows that are met without the coat and not under it
};

// The best weights. Where `target.without_coat` has rows and the best weights under the coat miss known rows that the
// best weights without it meet, these rows are held one after the other, the ones that are missed least first, as long
// as all that are held are met together. The l1 fit bounds that of kDeltaE and is a start of it, so that there the l1
// fit holds rows and tells which are lost; kDeltaE itself weighs the readings against each other.
CoatedFit fit_under_coat(FitMethod method, const FlakeTarget& target, const FlakeModel& model,
                         const Deadline& deadline);

}  // namespace goniochrome::fit
