// The work of goniogeom-index.
#pragma once

#include "cli/tool.h"
#include "options.h"

namespace goniochrome {

Result<cli::Verdict> run_goniogeom_index(const IndexOptions& options, cli::Session& session);

}  // namespace goniochrome
