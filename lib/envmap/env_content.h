// Prefiltered environments as bytes: the content of an `.env.exr` file.
#pragma once

#include <functional>
#include <string>

#include "base/result.h"
#include "envmap/prefiltered.h"

namespace goniochrome::envmap {

// Whether the content of a file is that of a prefiltered environment, whole or not, and no image to be filtered.
bool is_prefiltered(const std::string& content);

// As read_env(); `path` is what errors call the file.
Result<PrefilteredEnvironment> env_of_content(const std::string& content, const std::string& path,
                                              const std::function<bool(double exponent)>& is_wanted = {});

// As write_env().
Result<std::string> env_content(const std::string& path, const PrefilteredEnvironment& env, const std::string& command);

}  // namespace goniochrome::envmap
