// The files that a tool will write, looked at before it works for hours.
#pragma once

#include "base/result.h"
#include "cli/options.h"

namespace goniochrome::cli {

// Checks the files that the parsed options name for writing. Error: one cannot be written; two options name the same
// file; or a file is to be written that is also read, where a fault in the options would cost the original.
Result<void> check_outputs(const ToolSpec& spec);

}  // namespace goniochrome::cli
