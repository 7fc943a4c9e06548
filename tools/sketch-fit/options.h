// What sketch-fit takes.
#pragma once

#include <string>
#include <vector>

#include "cli/options.h"

namespace goniochrome::tool {

struct Options {
  cli::CommonOptions common;
  std::string image, buffers, env, basis, mask;
  std::vector<std::string> parts;
  std::string pixels = "auto", view = "paint", exposure = "auto";
  std::vector<double> shift;
  double glare_deg = 10, most_de76 = 10;
  std::string name = "sketch", output = "-", residual;
};

cli::ToolSpec tool_spec(Options& options);

}  // namespace goniochrome::tool
