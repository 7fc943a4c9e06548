// The options of fit-paint.
#pragma once

#include <string>
#include <vector>

#include "cli/options.h"

namespace goniochrome {

struct Options {
  cli::CommonOptions common;
  std::vector<std::string> paints;
  std::string basis;
  std::string output = "-";
  std::string method = "l1";
  std::string target = "measured";
  std::string weights = "perceptual";
  double gloss = 0;
};

cli::ToolSpec tool_spec(Options& options);

}  // namespace goniochrome
