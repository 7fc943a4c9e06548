#pragma once

#include "cli/tool.h"
#include "options.h"

namespace goniochrome {

Result<cli::Verdict> run(const PaintStatsOptions& options, cli::Session& session);

}  // namespace goniochrome
