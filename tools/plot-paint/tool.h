// plot-paint draws paints and their lobes.
#pragma once

#include <string>
#include <vector>

#include "cli/tool.h"

namespace goniochrome::tool {

struct Options {
  cli::CommonOptions common;
  std::vector<std::string> libraries;
  std::string output = "-";
  std::string pages;
  std::string format = "svg";
  std::vector<std::string> names;
  std::vector<std::string> brdfs;
  bool color_map = false, sparkle = false;
  std::string hud;  // a view; "" draws no rings
  std::vector<double> incidence_deg = {10, 40, 70};
};

cli::ToolSpec tool_spec(Options& options);
Result<cli::Verdict> run(const Options& options, cli::Session& session);

}  // namespace goniochrome::tool
