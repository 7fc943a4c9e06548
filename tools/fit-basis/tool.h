// fit-basis chooses the lobe exponents that serve a whole library best.
#pragma once

#include <string>
#include <vector>

#include "cli/tool.h"

namespace goniochrome::tool {

struct Options {
  cli::CommonOptions common;
  std::vector<std::string> paints;
  std::string output = "-";
  std::string name;
  std::string lobes = "1..11";
  std::string method = "power-mean";
  std::string target = "measured";
  std::string weights = "perceptual";
  std::string mirror = "auto";
  std::string each, table, plot;
  int starts = 6, representatives = 400;
  double visible_de00 = 0.5;
};

cli::ToolSpec tool_spec(Options& options);
Result<cli::Verdict> run(const Options& options, cli::Session& session);

}  // namespace goniochrome::tool
