// fit-paint fits paints to a basis of cosine lobes.
#pragma once

#include <string>
#include <vector>

#include "cli/tool.h"

namespace goniochrome::tool {

struct Options {
  cli::CommonOptions common;
  std::vector<std::string> paints;
  std::string basis;
  std::string output = "-";
  std::string method = "l1";
  std::string target = "measured";
  std::string weights = "perceptual";
  std::string gloss = "0";
  std::string coat = "auto";
  std::string satin = "several";
  std::string illuminant;
  int lobes = 0;
  double prune_de00 = 0;
  std::string views = "lost";
  double steepest_deg = 75;
  double paint_time_limit_s = 0;
  std::string color_map;
  std::string color_map_model = "better";
  std::string tilts = "8,16,32,64";
};

// True if weights for several views are fitted to more paints than those whose readings a coat would change.
inline bool views_asked(const Options& options) {
  return options.views != "none" && options.views != "lost";
}

cli::ToolSpec tool_spec(Options& options);
Result<cli::Verdict> run(const Options& options, cli::Session& session);

}  // namespace goniochrome::tool
