// draw-plot draws a table of points as a plot.
#pragma once

#include <string>
#include <vector>

#include "cli/tool.h"

namespace goniochrome::tool {

struct Options {
  cli::CommonOptions common;
  std::vector<std::string> table;
  std::string output = "-";
  std::string series = "series", x = "x", y = "y", style = "line";  // columns of the table, and its style without one
  std::string title, x_label, y_label;
  std::string logarithmic = "none";
  int width = 640, height = 400;
};

cli::ToolSpec tool_spec(Options& options);
Result<cli::Verdict> run(const Options& options, cli::Session& session);

}  // namespace goniochrome::tool
