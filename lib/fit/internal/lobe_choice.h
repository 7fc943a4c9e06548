// Fits with fewer lobes: the best subset of a given size, and the lobes whose absence would be seen.
// goniochrome-fitting(7), "FITTING".
#pragma once

#include <vector>

#include "fit/internal/flake_fit.h"

namespace goniochrome::fit {

// At most `count` of the exponents, those with the least objective. Where there are few subsets, all are tried; else
// one lobe at a time is added, and lobes are exchanged as long as that gains. At the deadline the best so far is
// returned.
std::vector<double> best_exponents(FitMethod method, const FlakeTarget& target, const std::vector<double>& exponents,
                                   int count, const Deadline& deadline);

// The exponents that are left when lobes are dropped one by one, the least visible first, as long as no row's color
// moves by more than `de00` from where all of them together put it.
std::vector<double> pruned_exponents(FitMethod method, const FlakeTarget& target, const std::vector<double>& exponents,
                                     double de00, const Deadline& deadline);

}  // namespace goniochrome::fit
