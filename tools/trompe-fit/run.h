// The work of trompe-fit.
#pragma once

#include "cli/tool.h"
#include "options.h"

namespace goniochrome {

Result<cli::Verdict> run_trompe_fit(const TrompeFitOptions& options, cli::Session& session);

}  // namespace goniochrome
