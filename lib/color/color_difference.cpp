#include "color/color_difference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "base/angles.h"
#include "base/text.h"
#include "math/elementary.h"

namespace goniochrome::color {

namespace {

using Kind = DifferenceFormula::Kind;

constexpr std::array kFormulaNames = {std::pair{Kind::kCie76, "cie76"},   std::pair{Kind::kCie94, "cie94"},
                                      std::pair{Kind::kCmc, "cmc"},       std::pair{Kind::kCiede2000, "ciede2000"},
                                      std::pair{Kind::kDin99o, "din99o"}, std::pair{Kind::kDin6175, "din6175"},
                                      std::pair{Kind::kCie76, "de76"},    std::pair{Kind::kCiede2000, "de00"}};

// The numbers by which dL, dC and dH are divided.
struct DifferenceWeights {
  double L = 1, C = 1, H = 1;
};

double weighted(const LabDifference& d, const DifferenceWeights& s) {
  return math::hypot(d.dL / s.L, d.dC / s.C, d.dH / s.H);
}

// CIE 116-1995, with the constants of the graphic arts.
DifferenceWeights cie94_weights(const Lab& standard) {
  const double c = chroma(standard);
  return {1, 1 + 0.045 * c, 1 + 0.015 * c};
}

// [Clarke, McDonald and Rigg 1984], BS 6923; l and c are those of the formula.
DifferenceWeights cmc_weights(const Lab& standard, double l, double c) {
  const double chroma_0 = chroma(standard), hue = hue_deg(standard);
  const double s_l = standard.L < 16 ? 0.511 : 0.040975 * standard.L / (1 + 0.01765 * standard.L);
  const double s_c = 0.0638 * chroma_0 / (1 + 0.0131 * chroma_0) + 0.638;
  const double fourth = chroma_0 * chroma_0 * chroma_0 * chroma_0;
  const double f = std::sqrt(fourth / (fourth + 1900));
  const double t = hue >= 164 && hue <= 345 ? 0.56 + std::abs(0.2 * math::cos((hue + 168) * kDegree))
                                            : 0.36 + std::abs(0.4 * math::cos((hue + 35) * kDegree));
  return {l * s_l, c * s_c, s_c * (f * t + 1 - f)};
}

// DIN 6176: the logarithms make a space in which the difference is a distance.
constexpr double kDin99oTurn_rad = 26 * kDegree, kDin99oSquash = 0.83, kDin99oChroma = 0.075, kDin99oScale = 0.0435;

double din99o_lightness(double L) {
  return 303.67 * math::log(1 + 0.0039 * L);
}

Lab din99o_color(const Lab& lab) {
  const double cosine = math::cos(kDin99oTurn_rad), sine = math::sin(kDin99oTurn_rad);
  const double e = lab.a * cosine + lab.b * sine, f = kDin99oSquash * (lab.b * cosine - lab.a * sine);
  const double g = math::hypot(e, f);
  // The turn back by 26 deg changes no distance.
  const double factor = g > 0 ? math::log1p(kDin99oChroma * g) / kDin99oScale / g : 0;
  return {din99o_lightness(lab.L), e * factor, f * factor};
}

// DIN 6175-2:2001, whose L and C are geometric means of both colors.
DifferenceWeights din6175_weights(double L, double C, double aspecular_deg) {
  const double g = std::abs(aspecular_deg);
  return {0.15 * std::sqrt(L) + 31.5 / g, std::max(0.7, 0.48 * std::sqrt(C) - 0.35 * std::sqrt(L) + 42 / g),
          std::max(0.7, 0.14 * std::sqrt(C) - 0.20 * std::sqrt(L) + 21 / g + 0.7)};
}
constexpr double kDin6175Gray = 0.7;  // S_a and S_b

double geometric_mean(double x, double y) {
  return std::sqrt(std::max(x, 0.0) * std::max(y, 0.0));
}

// Grays go by a* and b*, and colors by chroma and hue; the share w of the first falls around the chroma C0.
double din6175(const Lab& standard, const Lab& sample, double aspecular_deg) {
  if (aspecular_deg == 0) return std::numeric_limits<double>::quiet_NaN();
  const double L = geometric_mean(standard.L, sample.L), C = geometric_mean(chroma(standard), chroma(sample));
  const DifferenceWeights s = din6175_weights(L, C, aspecular_deg);
  const LabDifference d = lab_difference(standard, sample);
  const double gray = math::hypot(d.dL / s.L, d.da / kDin6175Gray, d.db / kDin6175Gray);
  const double middle = 10 + 8 / (1 + math::exp(27 - L));
  const double w = 1 / (1 + math::exp(C - middle));
  return w * gray + (1 - w) * weighted(d, s);
}

// The distance of a number from an interval; 0 inside.
double gap(double value, double low, double high) {
  return std::max({low - value, value - high, 0.0});
}

Result<DifferenceFormula> cmc_of(std::string_view text) {
  const auto parts = split(text, ':');
  const auto l = parts.size() == 3 ? parse_number(parts[1]) : std::nullopt;
  const auto c = parts.size() == 3 ? parse_number(parts[2]) : std::nullopt;
  if (!l || !c || !(*l > 0) || !(*c > 0) || *l > 100 || *c > 100)
    return usage_error("\"{}\": write cmc:L:C with two numbers above 0, as in cmc:2:1", shown(text));
  return DifferenceFormula{Kind::kCmc, *l, *c};
}

}  // namespace

// 2 sqrt(C0 C1) sin(turn/2) is the root of da^2 + db^2 - dC^2 without its cancellation.
LabDifference lab_difference(const Lab& standard, const Lab& sample) {
  const double c0 = chroma(standard), c1 = chroma(sample);
  const double turn =
      math::atan2(standard.a * sample.b - standard.b * sample.a, standard.a * sample.a + standard.b * sample.b);
  return {sample.L - standard.L, sample.a - standard.a, sample.b - standard.b, c1 - c0,
          2 * std::sqrt(c0 * c1) * math::sin(turn / 2)};
}

std::string formula_words() {
  return "cie76, cie94, cmc, cmc:L:C, ciede2000, din99o or din6175";
}

Result<DifferenceFormula> parse_formula(std::string_view text) {
  const std::string word = lower(trimmed(text));
  if (word.starts_with("cmc:")) return cmc_of(word);
  for (const auto& [kind, name] : kFormulaNames)
    if (word == name) return DifferenceFormula{kind};
  return usage_error("there is no color difference formula \"{}\": use {}", shown(text), formula_words());
}

std::string formula_name(const DifferenceFormula& formula) {
  if (formula.kind == Kind::kCmc)
    return fmt::format("cmc:{}:{}", shortest(formula.lightness), shortest(formula.chroma));
  return std::ranges::find(kFormulaNames, formula.kind, [](const auto& each) { return each.first; })->second;
}

double difference(const DifferenceFormula& formula, const Lab& standard, const Lab& sample, double aspecular_deg) {
  switch (formula.kind) {
    case Kind::kCie76:
      return delta_e_76(standard, sample);
    case Kind::kCie94:
      return weighted(lab_difference(standard, sample), cie94_weights(standard));
    case Kind::kCmc:
      return weighted(lab_difference(standard, sample), cmc_weights(standard, formula.lightness, formula.chroma));
    case Kind::kCiede2000:
      return delta_e_2000(standard, sample);
    case Kind::kDin99o:
      return delta_e_76(din99o_color(standard), din99o_color(sample));
    case Kind::kDin6175:
      break;
  }
  return din6175(standard, sample, aspecular_deg);
}

// Since dC^2 + dH^2 = da^2 + db^2, a difference with weights S is at least that of dL and of the distance in the a*b*
// plane over the larger of S_C and S_H, and both are least at the box's nearest point.
//
// DIN 99o is a distance after a map of the a*b* plane that turns it, squashes one axis by .83 and draws chromas g
// together to ln(1 + .075 g)/.0435. That logarithm is concave, so no direction is drawn together more than the radial
// one at the largest g, by .075/.0435/(1 + .075 g); and the image of a disc is a disc, hence convex, so that the bound
// of the derivative is one of distances.
//
// In DIN 6175, S_L and the terms of S_C and S_H grow or fall with L and C alone; each takes its largest value. The
// difference lies between that by a* and b* and that by chroma and hue, so that the larger of all weights bounds both.
double difference_floor(const DifferenceFormula& formula, const Lab& standard, const LabBox& box,
                        double aspecular_deg) {
  const auto& [low, high] = box;
  const double dL = gap(standard.L, low.L, high.L);
  const double plane = math::hypot(gap(standard.a, low.a, high.a), gap(standard.b, low.b, high.b));
  const double farthest =
      math::hypot(std::max(std::abs(low.a), std::abs(high.a)), std::max(std::abs(low.b), std::abs(high.b)));
  DifferenceWeights s;
  switch (formula.kind) {
    case Kind::kCie76:
      break;
    case Kind::kCie94:
      s = cie94_weights(standard);
      break;
    case Kind::kCmc:
      s = cmc_weights(standard, formula.lightness, formula.chroma);
      break;
    case Kind::kCiede2000:
      return 0;
    case Kind::kDin99o: {
      const double g = std::max(farthest, chroma(standard));
      const double slope = kDin99oChroma / kDin99oScale / (1 + kDin99oChroma * g);
      const double own = din99o_lightness(standard.L);
      return math::hypot(gap(own, din99o_lightness(low.L), din99o_lightness(high.L)), slope * kDin99oSquash * plane);
    }
    case Kind::kDin6175: {
      const double most_C = geometric_mean(chroma(standard), farthest);
      const double least_L = geometric_mean(standard.L, low.L), most_L = geometric_mean(standard.L, high.L);
      s = din6175_weights(least_L, most_C, aspecular_deg);
      s.L = din6175_weights(most_L, most_C, aspecular_deg).L;
      break;
    }
  }
  return math::hypot(dL / s.L, plane / std::max(s.C, s.H));
}

}  // namespace goniochrome::color
