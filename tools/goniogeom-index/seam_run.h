// goniogeom-index on a seam of a mesh.
#pragma once

#include "cli/tool.h"
#include "options.h"

namespace goniochrome::tool {

Result<cli::Verdict> run_on_seam(const Options& options, cli::Session& session);

}  // namespace goniochrome::tool
