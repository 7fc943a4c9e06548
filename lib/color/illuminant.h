// The names of illuminants and observers, in all the ways in which people and files write them.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "base/result.h"
#include "color/color.h"

namespace goniochrome::color {

// The CIE's name of an illuminant whose table is known here ("D65", "F11", "LED-B1"), for any name in use, in letters
// of either case: `d65`, `FL11`, `TL84`, `cwf`, `LED B1`. Nothing for others.
std::optional<std::string> illuminant_named(std::string_view text);

// The condition that `text` names: an illuminant, and behind a slash the observer (`D65/10`, `a/2`, `F11/10 deg`). The
// observer is 0 where none is named. Nothing for others.
std::optional<ViewingCondition> condition_in(std::string_view text);

// The illuminant among the words of a text such as `ILLUMINANT, D65` or `CIE D65/10 L*`, one without a table (D60, E)
// as well, and the observer behind its slash; "" and 0 where there is none.
ViewingCondition condition_among(std::string_view text);

// The condition of a name as condition_in() reads it, which is for `observer_deg` where it names no observer; the name
// stays as it is where it is no known illuminant's.
ViewingCondition condition_of(std::string_view name, int observer_deg);

// The observer, 2 or 10, at the beginning of `text`, by its degrees or its year (`10 degree`, `2`, `1931`); 0 for
// others.
int observer_in(std::string_view text);

}  // namespace goniochrome::color
