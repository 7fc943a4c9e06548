// fit-sbrdf makes a map of lobes from photographs of a surface.
#pragma once

#include <string>
#include <vector>

#include "cli/tool.h"

namespace goniochrome::tool {

struct Options {
  cli::CommonOptions common;
  std::vector<std::string> table;
  std::string output = "-", error_map, mask, normals, texels;
  std::string method = "best";
  int lobes = 2, holdout = 0, tile_rows = 0;
  double width = 1, noise = 0.02, saturated = 1e300;
  bool mend_exposures = false;
  Options() { common.tolerance = 0.1; }
};

cli::ToolSpec tool_spec(Options& options);
Result<cli::Verdict> run(const Options& options, cli::Session& session);

}  // namespace goniochrome::tool
