// What sketch-fit takes.
#pragma once

#include <string>
#include <vector>

#include "cli/options.h"

namespace goniochrome {

struct SketchFitOptions {
  std::string image, buffers, env, basis, mask;
  std::vector<std::string> parts;
  std::string pixels = "auto", view = "paint", exposure = "auto";
  std::vector<double> shift;
  double glare_deg = 10, most_de76 = 10;
  std::string name = "sketch", output = "-", residual;
};

cli::ToolSpec sketch_fit_spec(SketchFitOptions& options, cli::CommonOptions& common);

}  // namespace goniochrome
