// --probe: what single pixels of a picture with buffers show.
#pragma once

#include "tool.h"

namespace goniochrome::tool {

Result<cli::Verdict> run_probe(const Options& options, cli::Session& session);

}  // namespace goniochrome::tool
