// The work of draw-plot.
#pragma once

#include "cli/tool.h"
#include "options.h"

namespace goniochrome::tool {

// Error: a table that cannot be read, with its line; or a file that cannot be written.
Result<cli::Verdict> run(const Options& options, cli::Session& session);

}  // namespace goniochrome::tool
