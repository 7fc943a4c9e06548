// The heads-up rings of a paint on a rendered view. [Shimizu2009] 3.17.
#pragma once

#include "base/result.h"
#include "image/aov_file.h"
#include "paint/paint.h"
#include "report/plot.h"

namespace goniochrome::tool {

// A picture of render-osmesa, ready for rings.
struct HudView {
  int width = 0, height = 0;
  std::string png;               // its bytes
  std::vector<float> aspecular;  // degrees, line by line; 180 where nothing is seen
};

// Reads the picture and its buffer of aspecular angles. Error: the file lacks the buffer, or nothing is seen in it.
Result<HudView> read_hud_view(const std::string& path);

// The view with lines where the aspecular angle is 15 deg, 45 deg, and that at which the paint stops traveling, and
// below it the color of the paint at each. Error: the paint has neither readings nor an appearance.
Result<report::Drawing> hud_drawing(const paint::Paint& paint, const HudView& view);

// The line on which the values of a grid are `level`, as the data of an SVG path: the middles of pixels are at half
// numbers. Cells that are not wholly seen, and those across an edge of the mesh, have none.
std::string ring_path(const std::vector<float>& values, int width, int height, double level);

}  // namespace goniochrome::tool
