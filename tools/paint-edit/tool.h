// paint-edit makes a designer's moves on a stream of paints.
#pragma once

#include <string>
#include <vector>

#include "cli/tool.h"
#include "paint/edit.h"

namespace goniochrome::tool {

// A list is empty where the option is not given.
struct Options {
  cli::CommonOptions common;
  std::vector<std::string> inputs;
  std::string output = "-";
  std::vector<std::string> only;
  std::string suffix, rename, code, paint_class, new_name;
  std::vector<double> hue_deg, chroma, lightness, at_deg, face, flop, face_shift, flop_shift, travel_deg, gloss;
  double hue_shift_deg = 0, chroma_factor = 1, lightness_shift = 0, travel_shift_deg = 0, gloss_shift = 0;
  std::string gloss_angle_deg = "60", share = "exact";
  std::vector<std::string> readings;
  bool keep_residual = false, no_code = false;
  std::vector<double> anisotropy, flakes;
  std::string image;
  std::vector<double> at_pixel, travel_to, gloss_to;
  double lighter = 0;
  std::string variations;
  double step = 5;
  int gradient = 0;
};

cli::ToolSpec tool_spec(Options& options);
Result<cli::Verdict> run(const Options& options, cli::Session& session);

// True if the options change the name of a paint, its code or its class.
bool moves_identity(const Options& options);

// The moves that the options ask for. Error (usage): options that contradict each other or lack a number.
Result<paint::Edit> edit_of(const Options& options);

}  // namespace goniochrome::tool
