// The options of relight.
#pragma once

#include <string>
#include <vector>

#include "cli/options.h"

namespace goniochrome::tool {

struct Options {
  cli::CommonOptions common;
  std::vector<std::string> image;
  std::string output = "-";
  std::string from, to;
  std::string op = "iso";
  std::vector<double> transfer;
  std::string negative = "keep";
  std::string estimate;
};

cli::ToolSpec tool_spec(Options& options);

}  // namespace goniochrome::tool
