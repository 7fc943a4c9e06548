// Which lobes a paint wears, at any view.
#pragma once

#include "paint/paint.h"

namespace goniochrome::render {

enum class LobeWeight { kDirectionalDiffuse, kGloss };

// True if the lobe of this exponent, which may be the mirror's, has such a weight in the paint's own lobes or in those
// of one of its views: an exponent may stand in a view alone.
bool wears_lobe(const paint::LobeFit& paint, double exponent, LobeWeight weight);

}  // namespace goniochrome::render
