// paint-stats tells figures of paints, and picks paints by them.
#pragma once

#include <string>
#include <vector>

#include "cli/tool.h"

namespace goniochrome::tool {

struct Options {
  cli::CommonOptions common;
  std::vector<std::string> inputs;
  std::string output = "-";
  std::string format = "auto";
  std::string where;
  std::string score;
  std::vector<std::string> illuminants;
  std::string standard;
  std::string formula = "ciede2000";
  bool classify = false;
  bool keep_going = false;
};

cli::ToolSpec tool_spec(Options& options);
Result<cli::Verdict> run(const Options& options, cli::Session& session);

}  // namespace goniochrome::tool
