// The work of render-osmesa.
#pragma once

#include "cli/tool.h"
#include "options.h"

namespace goniochrome::tool {

// Reads, draws, checks and writes one picture.
Result<cli::Verdict> run(const Options& options, cli::Session& session);

}  // namespace goniochrome::tool
