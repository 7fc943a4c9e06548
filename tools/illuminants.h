// The option --illuminant, which tools share that look at paints in other light than that of their readings.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "base/text.h"
#include "color/illuminant.h"
#include "paint/spectra.h"

namespace goniochrome::tool {

// The illuminants of these lists, whose names are separated by commas, each once and in one spelling: `D65`, or
// `D65/10` where an observer is named that holds in the place of that of the readings. Error: one that is not known.
inline Result<std::vector<std::string>> illuminants_of(const std::vector<std::string>& lists) {
  std::vector<std::string> names;
  for (const std::string& list : lists)
    for (const std::string_view text : split(list, ',')) {
      const auto condition = color::condition_in(text);
      std::string name = condition ? condition->illuminant : std::string(trimmed(text));
      if (condition && condition->observer_deg != 0) name += fmt::format("/{}", condition->observer_deg);
      // The shortest spectrum is enough to hear whether the illuminant is known.
      const auto known = paint::lab_of({{}, 400, 300, {1, 1}}, {name, 10});
      if (!known.ok()) return usage_error("--illuminant: {}", known.error().message);
      if (std::ranges::find(names, name) == names.end()) names.push_back(std::move(name));
    }
  return names;
}

}  // namespace goniochrome::tool
