// Options whose one value says several things, taken apart before anything else looks at them.
#pragma once

#include "base/result.h"
#include "tool.h"

namespace goniochrome::tool {

constexpr const char* kGpu = "gpu";  // the engine gl on a GPU

// The options with what --camera, --check, --effects and --engine gpu say. Error (usage): a value that cannot be.
Result<Options> settled(const Options& asked);

}  // namespace goniochrome::tool
