// The basis that serves a whole database of paints best: the m exponents with which max + mean of the paints' errors is
// least, each paint fitted to them with non-negative weights. [Shimizu2009] 2.3.4.
// goniochrome-lobes(7), "CHOOSING THE BASIS".
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "brdf/rough_coat.h"
#include "color/color.h"
#include "fit/brdf_target.h"
#include "paint/curve.h"
#include "paint/paint.h"

namespace goniochrome::fit {

// One paint or measured BRDF as the search sees it.
struct BasisRow {
  double angle_deg = 0;  // aspecular, 0..90 and more
  color::Rgb value;      // reflectance factor, channels >= 0, of the base where there is a coat
  double weight = 1;     // of the error of each channel
  double passages = 1;   // what a coat leaves of the base's light there, see brdf::coat_passages()
};
// The angles of the viewer at which a coat is compared with the lobes of its gloss.
inline constexpr std::array<double, 5> kCoatErrorViews_deg = {20, 45, 60, 75, 85};
struct BasisTarget {
  std::string name;
  std::vector<BasisRow> rows;                // by ascending angle
  std::optional<brdf::RoughCoat> coat = {};  // whose gloss the basis is to hold, with a gray lobe of any weight each
  std::array<double, kCoatErrorViews_deg.size()> coat_weights = {1, 1, 1, 1, 1};  // of its share of light, by view
  bool mirror = false;  // beside the lobes, for the coat alone
  double floor = 0;     // the error that no lobes mend, see set_floors()
};

struct BasisTargetOptions {
  paint::TargetCurve::Kind target = paint::TargetCurve::Kind::kMeasured;
  bool perceptual_weights = true;  // rows weighted by dL*/dY, as fit-paint does
};

// The rows that fit-paint fits from the first reading on, under the coat that it gives the paint: readings, and with a
// tenth of their importance the curve between them. The rough coat is the one that the readings of gloss ask for (see
// brdf::rough_coat_of(); the search neglects what the base adds to a reading). A smooth coat asks for a mirror and not
// for lobes. Error: the paint has neither rows beyond glare nor an appearance, it has one angle only, or its illuminant
// is unknown.
Result<BasisTarget> basis_target(const paint::Paint& paint, const BasisTargetOptions& options);

// The means of a measured BRDF over all directions up to 75 deg from the normal, in steps of 2.5 deg of the aspecular
// angle from 10 to 110. Error: fewer than two steps hold a direction.
Result<BasisTarget> basis_target(const BrdfTarget& brdf, const BasisTargetOptions& options);

// Sets the floor of every target: its error with a dense series of exponents over the whole domain. Readings
// that contradict each other or grow away from specular leave such an error with any basis.
void set_floors(std::vector<BasisTarget>& targets);

// The root of the weighted mean square error over all angles and channels of a target, after the non-negative fit of a
// constant and lobes of these exponents, beyond the floor of the target. A coat adds the mean square error of the light
// within rings around the mirror direction, with the lobes and, where the target says so, the mirror.
double basis_error(const std::vector<double>& exponents, const BasisTarget& target);

// The square of that error and its gradient by log E_j, for every target.
struct SquaredError {
  double value = 0;
  std::vector<double> gradient;
};
std::vector<SquaredError> squared_basis_errors(const std::vector<double>& exponents,
                                               const std::vector<BasisTarget>& targets, bool with_gradient);

// The error over all targets, which the search makes least.
struct BasisError {
  double max = 0, mean = 0;
  double objective() const { return max + mean; }
  std::vector<double> each;  // per target
};
BasisError basis_error(const std::vector<double>& exponents, const std::vector<BasisTarget>& targets);

// The largest dE00 over the sample angles between a target and its best fit with these exponents.
double basis_de00(const std::vector<double>& exponents, const BasisTarget& target);

enum class BasisMethod {
  kPowerMean,  // quasi-Newton on the power mean of the errors, P = 4, 12, 40, then a pattern search on max + mean
  kLevenbergMarquardt,  // Ceres on the targets' errors, as in [Shimizu2009] 2.3.2, then the same pattern search
};

struct BasisSearchOptions {
  BasisMethod method = BasisMethod::kPowerMean;
  int first = 1, last = 11;  // numbers of lobes
  int starts = 6;            // for each number of lobes
  // How many targets stand for all in the search, where there are more than twice as many; 0: all of them are searched.
  std::size_t representatives = 400;
  // The domain of the exponents. The search also stays below the sharpest lobe that the targets see. A lobe of an
  // exponent below 1 falls to 0 at 90 deg with infinite slope, which shows as an edge.
  double low = 1, high = 2e4;
  std::uint64_t seed = 1;
  double time_limit_s = 0;  // for the whole search; 0 is none
};

// The best set found for one number of lobes.
struct FoundBasis {
  std::vector<double> exponents;  // ascending
  BasisError error;
  int starts = 0;
  int evaluations = 0;                   // of the objective
  int looked_at = 0;                     // targets that the search looked at; `error` is that of all
  bool at_low = false, at_high = false;  // an exponent lies at that end of the domain
  double time_s = 0;
};

struct BasisSearch {
  std::vector<FoundBasis> sets;  // by number of lobes, from `first`; fewer where the time limit struck
  bool stopped = false;          // by the time limit
};

// Searches with one more lobe at a time. Every set starts from the best smaller one with a lobe put into each wide gap,
// from exponents that are regular in log space, and from random ones. The objective never rises with the number of
// lobes. The result depends on the seed, and not on the number of threads.
//
// A large library is searched on representatives. The targets are sorted by their error with five regular exponents and
// cut into as many parts of equal size; the middle one of each part counts for it in the mean. After each search the
// errors of all targets are computed, and the worst ones join until none is beyond the largest of those that were
// looked at by more than 0.1 %. On 5,000 paints the objective stays within 0.5 % of that of the search on all.
BasisSearch search_basis(const std::vector<BasisTarget>& targets, const BasisSearchOptions& options);

}  // namespace goniochrome::fit
