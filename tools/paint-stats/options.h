// The options of paint-stats.
#pragma once

#include <string>
#include <vector>

#include "cli/options.h"

namespace goniochrome::tool {

struct Options {
  cli::CommonOptions common;
  std::vector<std::string> inputs;
  std::string output = "-";
  std::string format = "auto";
  std::string where;
  bool keep_going = false;
};

cli::ToolSpec tool_spec(Options& options);

}  // namespace goniochrome::tool
