// paint-studio writes a page in which a paint is designed by hand and eye.
#pragma once

#include <string>
#include <vector>

#include "cli/tool.h"

namespace goniochrome::tool {

struct Options {
  cli::CommonOptions common;
  std::vector<std::string> paints;
  std::string mesh, basis, output = "-", title, print_profile;
  std::vector<std::string> environments, transports;
  bool empty = false;
};

cli::ToolSpec tool_spec(Options& options);
Result<cli::Verdict> run(const Options& options, cli::Session& session);

}  // namespace goniochrome::tool
