// The work of paint-stats.
#pragma once

#include "cli/tool.h"
#include "options.h"

namespace goniochrome::tool {

Result<cli::Verdict> run(const Options& options, cli::Session& session);

}  // namespace goniochrome::tool
