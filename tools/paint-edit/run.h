// The work of paint-edit.
#pragma once

#include "cli/tool.h"
#include "options.h"

namespace goniochrome {

Result<cli::Verdict> run_paint_edit(const PaintEditOptions& options, cli::Session& session);

}  // namespace goniochrome
