#pragma once

#include "cli/tool.h"
#include "options.h"

namespace goniochrome {

Result<cli::Verdict> run(const ColorsnapOptions& options, cli::Session& session);

}  // namespace goniochrome
