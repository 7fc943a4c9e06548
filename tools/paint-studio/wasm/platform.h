// The replacements for files and threads in WebAssembly.
#pragma once

#include <string>

namespace goniochrome::studio {

// All that was written to an OutputFile since it was cleared last.
std::string& written_text();

}  // namespace goniochrome::studio
