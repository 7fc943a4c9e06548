// paint-compare judges paints against their standards.
#pragma once

#include <string>
#include <vector>

#include "cli/tool.h"

namespace goniochrome::tool {

struct Options {
  cli::CommonOptions common;
  std::vector<std::string> inputs;
  std::string standard;
  std::string pair = "auto";
  std::vector<std::string> formulas;
  std::vector<std::string> illuminants;
  std::string limits, make_limits, show_limit;
  double spread = 3, share = 0;
  std::string output = "-";
  std::string format = "auto";
  std::string chart, mesh, env;
  bool keep_going = false;
};

cli::ToolSpec tool_spec(Options& options);
Result<cli::Verdict> run(const Options& options, cli::Session& session);

}  // namespace goniochrome::tool
