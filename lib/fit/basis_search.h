// The basis that serves a whole database of paints best: m exponents such that
// max + mean of the paints' errors after the inner non-negative fit is least.
// [Shimizu2009] 2.3.4. goniochrome-theory(7), CHOOSING THE BASIS.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/clock.h"
#include "base/result.h"

namespace goniochrome::fit {

// One paint (or measured BRDF) as the search sees it: BRDF values times weights
// at sample angles, channel by channel.
struct BasisTarget {
  std::string name;
  std::vector<double> angles_deg;             // aspecular, 0..90
  std::array<std::vector<double>, 3> value;   // pi f per channel at those angles
  std::array<std::vector<double>, 3> weight;  // of each value's residual
};

// err(E, B): weighted RMS over all angles and channels after the non-negative
// fit of a constant and the lobes.
double basis_error(const std::vector<double>& exponents, const BasisTarget& target);

// err^2 of every target and its gradient by log E_j.
struct SquaredError {
  double value = 0;
  std::vector<double> gradient;
};
std::vector<SquaredError> squared_basis_errors(const std::vector<double>& exponents,
                                               const std::vector<BasisTarget>& targets, bool with_gradient);

struct BasisError {
  double max = 0, mean = 0;
  double objective() const { return max + mean; }
  std::vector<double> each;  // per target
};
BasisError basis_error(const std::vector<double>& exponents, const std::vector<BasisTarget>& targets);

enum class BasisMethod {
  kPowerMean,           // quasi-Newton on the power mean of the errors, P = 4, 12, 40,
                        // then a pattern search on the objective
  kLevenbergMarquardt,  // Ceres on the residual norms, as in [Shimizu2009], then
                        // the same pattern search
};

struct BasisSearchOptions {
  BasisMethod method = BasisMethod::kPowerMean;
  int first = 1, last = 11;  // numbers of lobes
  int starts = 6;            // for each number of lobes
  // Domain of the exponents, up to the sharpest lobe that the targets see. Below 1 a lobe falls to 0 at 90 deg with
  // infinite slope, which shows as an edge.
  double low = 1, high = 2e4;
  std::uint64_t seed = 1;
  double time_limit_s = 0;  // for the whole search; 0 is none
};

// The best set found for one number of lobes.
struct FoundBasis {
  std::vector<double> exponents;  // ascending
  BasisError error;               // the exact max and mean
  int starts = 0;
  int evaluations = 0;  // of the objective
  double time_s = 0;
};

struct BasisSearch {
  std::vector<FoundBasis> sets;  // by number of lobes, from `first`; fewer where
                                 // the time limit struck
  bool stopped = false;
};

// One lobe at a time: every set starts from the best smaller one with a lobe
// put into each wide gap, from exponents regular in log space, and from random
// ones. Deterministic for a seed, whatever the number of threads. The objective
// never rises with m.
BasisSearch search_basis(const std::vector<BasisTarget>& targets, const BasisSearchOptions& options);

}  // namespace goniochrome::fit
