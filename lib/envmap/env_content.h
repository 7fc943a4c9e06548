// Prefiltered environments as bytes: the content of an `.env.exr` file.
#pragma once

#include <functional>
#include <string>

#include "base/result.h"
#include "envmap/prefiltered.h"

namespace goniochrome::envmap {

// True if the content of a file is a prefiltered environment, even a damaged one, and not an image to be filtered.
bool is_prefiltered(const std::string& content);

// Reads the content of a file like read_env(). Errors call the file `path`.
Result<PrefilteredEnvironment> env_of_content(const std::string& content, const std::string& path,
                                              const std::function<bool(double exponent)>& is_wanted = {});

// Returns the content that write_env() would write to `path`.
Result<std::string> env_content(const std::string& path, const PrefilteredEnvironment& env, const std::string& command);

}  // namespace goniochrome::envmap
