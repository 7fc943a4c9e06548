// The options of paint-stats.
#pragma once

#include <string>
#include <vector>

#include "cli/options.h"

namespace goniochrome {

struct PaintStatsOptions {
  std::vector<std::string> inputs;
  std::string output = "-";
  std::string format = "auto";
  std::string where;
  bool keep_going = false;
};

cli::ToolSpec paint_stats_spec(PaintStatsOptions& options, cli::CommonOptions& common);

}  // namespace goniochrome
