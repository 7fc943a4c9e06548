// The work of prefilter-envmap.
#pragma once

#include "cli/tool.h"
#include "options.h"

namespace goniochrome::tool {

Result<cli::Verdict> run(const Options& options, cli::Session& session);

}  // namespace goniochrome::tool
