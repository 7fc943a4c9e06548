// Moves at a place in a picture of the painted mesh, by the aspecular angle under a pixel. See [Shimizu2009] 3.6 and
// goniochrome-paint(7), "DESIGN MOVES".
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "tool.h"

namespace goniochrome::tool {

// A pixel that an option names, and the aspecular angle (deg) seen there: from the first lamp, or in traced light that
// of the one lamp which would show the paint alike.
struct SeenPixel {
  std::string option;
  int x = 0, y = 0;
  double aspecular_deg = 0;
  bool traced = false;
};

// Where --image holds light that was traced, the angles of --at-pixel and --travel-to are those of that light, since
// the mesh may hide the lamp. --gloss-to is about the highlight of the lamp and takes the angle from it.
//
// Returns the options with every place in --image replaced by an angle: --at-pixel becomes --at, --travel-to becomes
// --travel, and --gloss-to becomes --gloss. --lighter, --chroma and --hue become the shifts at that place. Options
// without a place come back as they are. Error: what is missing, an image without the buffer, a pixel outside or beside
// the mesh, or one so near specular that no travel ends there.
struct PlacedOptions {
  Options options;
  std::vector<SeenPixel> pixels;
  std::string drawn_by_rays;  // as image::AovFile has it, of --image
};
Result<PlacedOptions> placed(const Options& options);

}  // namespace goniochrome::tool
