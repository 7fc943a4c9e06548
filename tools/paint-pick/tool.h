// paint-pick makes paints from pictures.
#pragma once

#include <string>
#include <vector>

#include "cli/tool.h"

namespace goniochrome::tool {

struct Options {
  cli::CommonOptions common;
  std::vector<std::string> images, probes;
  std::string face, flop, gloss, buffers;
  double travel_deg = 60;
  bool retro = false;
  std::string name = "picked";
  int palette = 0;
  std::string board, output = "-";
  std::string mesh, env, basis, studio;
};

cli::ToolSpec tool_spec(Options& options);
Result<cli::Verdict> run(const Options& options, cli::Session& session);

}  // namespace goniochrome::tool
