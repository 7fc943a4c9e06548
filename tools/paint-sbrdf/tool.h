// paint-sbrdf makes maps of spatially varying surfaces of paints, pictures and other maps, and changes them.
#pragma once

#include <string>
#include <vector>

#include "cli/tool.h"

namespace goniochrome::tool {

// A list or a text is empty where the option is not given.
struct Options {
  cli::CommonOptions common;
  std::vector<std::string> inputs;
  std::string output = "-";
  // Where each surface lies.
  std::vector<double> stripe, mix, place;
  bool gradient = false, invert = false;
  std::string mask, decal;
  int mosaic = 0;
  double angle_deg = 0;
  // The changes of the map.
  std::string size, tile;
  std::vector<double> crop;
  double turn_deg = 0;
  std::string gloss, polish, wear;
  // Lobes.
  int lobes = 0;
  double mirror = 0;
};

cli::ToolSpec tool_spec(Options& options);
Result<cli::Verdict> run(const Options& options, cli::Session& session);

}  // namespace goniochrome::tool
