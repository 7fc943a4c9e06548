// Surfaces with fewer lobes, fast enough for every texel of a texture. Where time does not matter, fit/surface_refit.h
// is nearer. goniochrome-surfaces(7), "Minification".
#pragma once

#include "brdf/lobe_surface.h"

namespace goniochrome::brdf {

// The surface with at most `most` lobes: again and again the two lobes whose union loses least become one, which
// reflects to each viewer what both do, as far as one lobe can. At last the albedos are scaled so that viewers see the
// light of the whole surface. Deterministic. `most` is 1 or more.
LobeSurface merged(LobeSurface surface, int most);

}  // namespace goniochrome::brdf
