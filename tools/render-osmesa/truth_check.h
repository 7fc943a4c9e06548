// --check against path traced truth.
#pragma once

#include <string>

#include "cli/tool.h"
#include "render/truth.h"

namespace goniochrome::tool {

// Reports the comparison, and says it in a sentence: the total, and its causes.
void tell_truth(const render::TruthError& error, const std::string& source, double tolerance, cli::Session& session);

}  // namespace goniochrome::tool
