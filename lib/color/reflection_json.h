// Reflection operators as JSON files: {"k": [[[..3..],[..],[..]], [..], [..]]}, by output channel, then both colors.
#pragma once

#include <string>

#include "color/reflection.h"

namespace goniochrome::color {

// Shortest digits that read back as the same numbers, and a line feed.
std::string reflection_json(const ReflectionOperator& op);

// Reads such a file. Error: the file, and what is missing; an operator that is not symmetric and coherent to 1e-6 is
// refused with its row.
Result<ReflectionOperator> read_reflection_operator(const std::string& path);

}  // namespace goniochrome::color
