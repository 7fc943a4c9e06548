// The maps of a prefiltered environment side by side, as a picture that tells at a glance what each lobe sees.
#pragma once

#include <string>

#include "base/result.h"
#include "envmap/prefiltered.h"
#include "image/image.h"

namespace goniochrome::tool {

// Every map as a lat-long panorama (+Y up, +Z in the middle, +X to the left of it), with its exponent beside it,
// through the view Paint on an sRGB display (signals 0..1). All maps have one exposure, at which their mean luminance
// shows as middle gray of 18 %. The maps must be cubes, and there must be one at least.
image::Image contact_sheet(const envmap::PrefilteredEnvironment& env);

}  // namespace goniochrome::tool
