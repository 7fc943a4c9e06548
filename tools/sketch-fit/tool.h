// sketch-fit goes from an edited picture of a painted mesh back to the paint.
#pragma once

#include <string>
#include <vector>

#include "cli/tool.h"

namespace goniochrome::tool {

struct Options {
  cli::CommonOptions common;
  std::string image, buffers, env, basis, mask;
  std::vector<std::string> parts;
  std::string pixels = "auto", view = "auto", exposure = "auto", registration = "auto";
  std::vector<double> shift;
  double glare_deg = 10, most_de76 = 10;
  std::string name = "sketch", output = "-", residual, start;
};

cli::ToolSpec tool_spec(Options& options);
Result<cli::Verdict> run(const Options& options, cli::Session& session);

}  // namespace goniochrome::tool
