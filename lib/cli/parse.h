// From argv to the values of an option table.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "cli/options.h"

namespace goniochrome::cli {

// Writes the values of `arguments` (without the program's name) into the table's targets. The error, of kind kUsage,
// names the option, its value and what it takes; for an unknown option it names the nearest known one.
Result<void> parse(const ToolSpec& spec, const std::vector<std::string>& arguments);

}  // namespace goniochrome::cli
