// The work of sketch-fit.
#pragma once

#include "cli/tool.h"
#include "options.h"

namespace goniochrome {

Result<cli::Verdict> run_sketch_fit(const SketchFitOptions& options, cli::Session& session);

}  // namespace goniochrome
