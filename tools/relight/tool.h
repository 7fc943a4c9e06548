// relight turns an HDR image from one illuminant to another.
#pragma once

#include <string>
#include <vector>

#include "cli/tool.h"
#include "color/reflection_file.h"

namespace goniochrome::tool {

struct Options {
  cli::CommonOptions common;
  std::vector<std::string> image;
  std::string output = "-";
  std::string from, to;
  std::string op = color::kDefaultOperator;
  std::vector<double> transfer;
  std::string negative = "keep";
  std::string estimate, primaries;
};

cli::ToolSpec tool_spec(Options& options);
Result<cli::Verdict> run(const Options& options, cli::Session& session);

}  // namespace goniochrome::tool
