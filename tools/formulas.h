// The color difference formulas of the option --formula.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "base/text.h"
#include "color/color_difference.h"

namespace goniochrome::tool {

inline Result<color::DifferenceFormula> formula_of(std::string_view text) {
  auto formula = color::parse_formula(text);
  if (!formula.ok()) return usage_error("--formula: {}", formula.error().message);
  return formula;
}

// The formulas of these lists, whose names are separated by commas, each once. Error (usage): one that is not known.
inline Result<std::vector<color::DifferenceFormula>> formulas_of(const std::vector<std::string>& lists) {
  std::vector<color::DifferenceFormula> formulas;
  for (const std::string& list : lists)
    for (const std::string_view text : split(list, ',')) {
      GONIO_ASSIGN(const color::DifferenceFormula formula, formula_of(text));
      if (std::ranges::find(formulas, formula) == formulas.end()) formulas.push_back(formula);
    }
  return formulas;
}

}  // namespace goniochrome::tool
