// Streams of paints under an environment in the open: its light is looked up once for each point and lobe.
#pragma once

#include <memory>

#include "paint_views.h"

namespace goniochrome::tool {

// True if the view can be kept as light by lobes: an environment alone, nothing on the mesh that is no sum of lobes, no
// engine asked for but cpu, and not so many samples that their light would take more than 100 MB.
bool has_open_views(const Options& options, const Request& request, const Stage& stage);

// Draws the paints of a stream from that light, in a few milliseconds. Paints that it cannot show (brushed ones, color
// maps, lobes that the environment lacks) are left to `others`. Coats are taken with an index that is rounded to 1/50,
// and the base under them is scaled to look the same at 45 degrees.
std::unique_ptr<PaintViews> open_views(const Options& options, const Request& request, Stage& stage,
                                       std::unique_ptr<PaintViews> others);

}  // namespace goniochrome::tool
