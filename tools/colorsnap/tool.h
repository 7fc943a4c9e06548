// colorsnap finds the paints of a library that are nearest to a paint.
#pragma once

#include <string>
#include <vector>

#include "cli/tool.h"
#include "library/search.h"

namespace goniochrome::tool {

struct Options {
  cli::CommonOptions common;
  std::vector<std::string> inputs;
  std::string library;
  std::string output = "-", cloud;
  std::string format = "auto";
  int count = 5;
  std::string formula = "cie76";
  std::vector<std::string> geometries;
  std::vector<std::string> weights;
  std::vector<std::string> filters;
  std::vector<std::string> illuminants;
  std::string method = "auto";
  double threshold = 10;
  double off_radial = 5;
  double hue_travel = 30;
  bool mix_observers = false;
  bool keep_going = false;
  bool assign = false;
};

cli::ToolSpec tool_spec(Options& options);
Result<cli::Verdict> run(const Options& options, cli::Session& session);

// The search that the options ask for. Error: a text that cannot be understood.
Result<library::LibrarySearchOptions> search_options(const Options& options);

}  // namespace goniochrome::tool
