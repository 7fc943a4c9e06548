// The mean square of the radiance by the lobes of an environment, from which the grain of flakes follows that show
// single directions of it. goniochrome-flakes(7), "LIGHT".
#pragma once

#include "prefilter/prefilter.h"

namespace goniochrome::prefilter {

// Gives each lobe of `env`, which was made by this request, its root mean square of what the bright spots leave of the
// environment. The maps are as small as an error of 1 part in 100 allows.
void keep_rms_maps(const envmap::Environment& environment, const PrefilterRequest& request,
                   envmap::PrefilteredEnvironment& env);

}  // namespace goniochrome::prefilter
