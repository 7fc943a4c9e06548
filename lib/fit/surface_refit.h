// Fewer lobes that reflect as many do. A mixture of two surfaces is the sum of their lobes; where a texel has room for
// fewer, new lobes are fitted to samples of the sum [McAllister2002, 7]. goniochrome-surfaces(7), "Mixtures".
#pragma once

#include "brdf/lobe_surface.h"

namespace goniochrome::fit {

struct Refit {
  brdf::LobeSurface surface;  // in one frame
  double error = 0;           // see refit_error(); 0 where the target is returned as it is
};

// At most `lobes` lobes in one frame that reflect as `target` does; the target itself where it is that already.
// Deterministic. All values of the target must be finite, and none of its albedos negative.
Refit refit(const brdf::LobeSurface& target, int lobes);

// How far two surfaces are apart, relative to the first: the root of the mean of (f - g)^2/f over that of f, the means
// over viewers and light by the cosines of both. The samples are those of refit().
double refit_error(const brdf::LobeSurface& target, const brdf::LobeSurface& other);

}  // namespace goniochrome::fit
