// The work of paint-pick.
#pragma once

#include "cli/tool.h"
#include "options.h"

namespace goniochrome {

Result<cli::Verdict> run_paint_pick(const PaintPickOptions& options, cli::Session& session);

}  // namespace goniochrome
