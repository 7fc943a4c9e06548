// The source's choice of search for the basis: Levenberg-Marquardt on the
// paints' errors, by Ceres. [Shimizu2009] 2.3.2
#pragma once

#include <vector>

#include "base/clock.h"
#include "fit/basis_search.h"

namespace goniochrome::fit {

// Moves the logarithms of the exponents, kept in [low, high], to a local
// minimum of sum err^2 over the targets with the largest errors weighed up.
// Returns the number of evaluations.
int minimize_by_levenberg_marquardt(const std::vector<BasisTarget>& targets, double low, double high,
                                    const Deadline& deadline, std::vector<double>& logs);

}  // namespace goniochrome::fit
