// The work of paint-convert.
#pragma once

#include "base/result.h"
#include "cli/tool.h"
#include "options.h"

namespace goniochrome {

Result<cli::Verdict> run_paint_convert(const ConvertOptions& options, cli::Session& session);

}  // namespace goniochrome
