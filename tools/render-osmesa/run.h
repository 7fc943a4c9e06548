#pragma once

#include "cli/tool.h"
#include "options.h"

namespace goniochrome {

// Reads, draws, checks and writes one picture.
Result<cli::Verdict> run(const RenderOptions& options, cli::Session& session);

}  // namespace goniochrome
