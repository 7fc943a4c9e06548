// paint-convert reads paints in any format and writes them in any other.
#pragma once

#include <string>
#include <vector>

#include "cli/tool.h"

namespace goniochrome::tool {

struct Options {
  cli::CommonOptions common;
  std::vector<std::string> inputs;
  std::string output = "-";
  std::string from = "auto", to = "auto";
  std::vector<std::string> geometry;
  std::string illuminant = "auto", observer = "auto";
  std::string scale = "auto";
  std::vector<std::string> viewings;
  double aperture_deg = 0;
  bool cxf_compat = false;
  std::string columns = "core";
  std::string average = "none", outliers = "keep";
  bool fit_appearance = false;
  bool keep_going = false;
};

cli::ToolSpec tool_spec(Options& options);
Result<cli::Verdict> run(const Options& options, cli::Session& session);

}  // namespace goniochrome::tool
