// The grain of a paint's flakes against the distance of the viewer.
#pragma once

#include "paint/paint.h"
#include "report/plot.h"

namespace goniochrome::tool {

// The contrast, standard deviation over mean, of what an eye tells apart of a panel in the sun: patches one minute of
// arc wide. goniochrome-flakes(7). The paint must have lobes with flakes, and known flakes.
report::Drawing sparkle_page(const paint::Paint& paint, const paint::KnownFlakes& known);

}  // namespace goniochrome::tool
