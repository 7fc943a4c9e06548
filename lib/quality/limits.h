// Tolerances: the limits of quantities at geometries, as a table of text; whether a comparison keeps them, in words
// that a painter understands; and the paints that lie on their limits. goniochrome-paint(5), "LIMITS".
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "paint/paint.h"
#include "quality/comparison.h"

namespace goniochrome::quality {

// The namespace of the elements that hold limits and verdicts in paint XML.
inline constexpr const char* kQualityNamespace = "urn:goniochrome:quality:1";

// True for the element of this name in that namespace, as paint::Paint::foreign has it.
bool is_quality_element(std::string_view element, std::string_view name);

// A number within 1e-9 of a limit keeps it, since differences of decimals carry rounding.
inline constexpr double kLimitSlack = 1e-9;

// At least one of `low` and `high` is there.
struct Limit {
  std::string at;        // a geometry, kMean, kLargest or kWhole, or "*" for each geometry, or the paint
  std::string quantity;  // of a Deviation; "dE" is the first formula
  std::optional<double> low = {}, high = {};
};

// The limits of a table with the columns geometry, quantity, low and high. `name` is told in errors: a quantity that is
// not known, a number that is none, low above high, a row without a limit.
Result<std::vector<Limit>> parse_limits(std::string_view table, const std::string& name);
std::string limits_table(const std::vector<Limit>& limits);

// The limits that a paint carries as an element of its own, or none. Error: they are damaged.
Result<std::vector<Limit>> limits_of(const paint::Paint& paint);
// The paint with these limits in the place of those that it had.
paint::Paint with_limits(paint::Paint paint, const std::vector<Limit>& limits);

// Adds the formulas and illuminants that the limits name to those of the options.
Result<void> add_needed(const std::vector<Limit>& limits, CompareOptions& options);

// A limit that is not kept, or whose quantity was not measured; the value is NaN then.
struct Excess {
  Deviation deviation;
  std::optional<double> low, high;  // the bound that is passed; both where there was no value
  std::string words;                // "45as15: dL -2.1, limit -1.5: too dark near gloss"
};

// A comparison beside its limits.
struct Judged {
  std::vector<Excess> excesses;     // measured ones first
  std::vector<std::string> places;  // to which a limit applies

  // At a place, and at kWhole of all places: "fail" where a limit is passed, else "incomplete" where a quantity that
  // has a limit was not measured, else "pass"; "-" where no limit applies.
  const char* verdict(const std::string& at = kWhole) const;
};
Judged judged(const Comparison& comparison, const CompareOptions& options, const std::vector<Limit>& limits);

// The standard, and after it the eight paints that just keep the limits at every geometry: lighter and darker ones, and
// six in directions of hue 60 deg apart, named as those of paint::neighbors(). They have rows alone. Error: no limit
// bounds a direction.
Result<std::vector<paint::Paint>> just_passing(const paint::Paint& standard, const CompareOptions& options,
                                               const std::vector<Limit>& limits);

}  // namespace goniochrome::quality
