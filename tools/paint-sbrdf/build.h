// From surfaces and a pattern to the texels of a map.
#pragma once

#include "brdf/sbrdf.h"
#include "cli/tool.h"
#include "pattern.h"
#include "surfaces.h"

namespace goniochrome::tool {

// Where on the whole map the texels of the output lie.
struct Layout {
  int width = 0, height = 0;                               // of the whole map
  int left = 0, top = 0, crop_width = 0, crop_height = 0;  // of what is kept of it
  int columns = 1, rows = 1;                               // how often that is repeated
};

// By --size, --crop and --tile. Error (usage): a number that is none, a part outside of the map, too many texels.
Result<Layout> layout_of(const Options& options, const Surfaces& surfaces, const Pattern& pattern);

struct BuiltMap {
  brdf::SbrdfTexture texture;
  std::vector<double> share;  // of each surface
  std::size_t refitted = 0;   // texels
  bool frames = false;        // whether lobes have frames of their own
  double error_mean = 0, error_max = 0, albedo_max = 0;
  double alpha_mean = 0;
  double lowest = 0, highest = 0;  // exponents that reflect; highest < lowest: none does
};

Result<BuiltMap> built_map(const Options& options, const Surfaces& surfaces, const Pattern& pattern,
                           const Layout& layout, cli::Session& session);

}  // namespace goniochrome::tool
