// prefilter-envmap filters an HDR environment by every lobe of a basis.
#pragma once

#include <string>
#include <vector>

#include "cli/tool.h"
#include "envmap/bright_spots.h"

namespace goniochrome::tool {

struct Options {
  cli::CommonOptions common;
  std::vector<std::string> images;
  std::string output = "-";
  std::string basis;
  std::vector<double> exponents;
  std::string size = "auto";
  int verify = 0;
  std::string bad_pixels = "error";
  bool no_mirror = false;
  bool no_open_maps = false;
  bool sparkle = false;
  std::string paints;  // --for
  std::string layout = "env";
  std::string cache;
  std::string picture;
  std::vector<double> rotate;
  std::string ball;
  double exposure = 0;
  double horizon = -90;
  int spots = envmap::kUsualSpots;
};

cli::ToolSpec tool_spec(Options& options);
Result<cli::Verdict> run(const Options& options, cli::Session& session);

}  // namespace goniochrome::tool
