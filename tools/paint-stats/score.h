// How far each model of a paint is from measured directions.
#pragma once

#include "cli/tool.h"
#include "tool.h"

namespace goniochrome::tool {

// Compares the curve, the lobes and the color map of each paint with the directions of options.score, and writes one
// line for each model. Error: the table or a map cannot be read, or no paint has a model and measured directions.
Result<cli::Verdict> score(const Options& options, cli::Session& session);

}  // namespace goniochrome::tool
