// From argv to the values of an option table.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "cli/options.h"

namespace goniochrome::cli {

// Writes the values of `arguments` (without the program's name) into the table's targets. Error (kUsage): the option,
// its value and what it takes; an unknown option names the nearest known one.
Result<void> parse(const ToolSpec& spec, const std::vector<std::string>& arguments);

}  // namespace goniochrome::cli
