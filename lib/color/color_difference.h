// Color differences of a sample from a standard by the formulas of the industry. Every difference is sample minus
// standard. CIE 1994 and CMC weigh it by the standard alone, so that they change where the two trade places.
// goniochrome-color(7), "COLOR DIFFERENCES".
#pragma once

#include <string>
#include <string_view>

#include "base/result.h"
#include "color/color.h"

namespace goniochrome::color {

// Differences in lightness, along a* and b*, in chroma and in hue, CIELAB units: dE76^2 = dL^2 + da^2 + db^2 = dL^2 +
// dC^2 + dH^2. dH is positive where the hue angle of the sample lies counterclockwise from that of the standard.
struct LabDifference {
  double dL = 0, da = 0, db = 0, dC = 0, dH = 0;
};
LabDifference lab_difference(const Lab& standard, const Lab& sample);

// One formula with its parameters.
struct DifferenceFormula {
  enum class Kind { kCie76, kCie94, kCmc, kCiede2000, kDin99o, kDin6175 } kind = Kind::kCie76;
  double lightness = 2, chroma = 1;  // l and c of CMC(l:c)
  friend bool operator==(const DifferenceFormula&, const DifferenceFormula&) = default;
};

// The formula that is spelled cie76, cie94, cmc, cmc:L:C, ciede2000, din99o or din6175; de76 and de00 are understood
// too. Error (usage): the text and these words.
Result<DifferenceFormula> parse_formula(std::string_view text);
std::string formula_words();  // for help and messages

// Its name, which parse_formula() reads: "cmc:2:1".
std::string formula_name(const DifferenceFormula& formula);

// The difference, 0 or more. DIN 6175 alone asks for the aspecular angle, by its absolute value; it is NaN at 0, where
// its weights are infinite.
double difference(const DifferenceFormula& formula, const Lab& standard, const Lab& sample, double aspecular_deg);

// Colors with lower.L <= L <= upper.L, and so on.
struct LabBox {
  Lab lower, upper;
};

// A number that is not above the difference of any sample in `box`, except for rounding. The box may be a point. Of
// CIEDE2000 it is 0, whose bound is library::de00_floor().
double difference_floor(const DifferenceFormula& formula, const Lab& standard, const LabBox& box, double aspecular_deg);

}  // namespace goniochrome::color
