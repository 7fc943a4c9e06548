// Tilted lobes fitted to a color map, so that pictures by prefiltered maps come close to the map's own integral in any
// image light. goniochrome-interference(7), "TILTED LOBES".
#pragma once

#include <vector>

#include "base/result.h"
#include "brdf/color_map.h"
#include "formats/basis.h"
#include "paint/paint.h"

namespace goniochrome::fit {

struct TiltOptions {
  // Look-ups in prefiltered maps that each set may take, ascending. Each count gives a set, unless it is hardly better
  // than the set before.
  std::vector<int> lookups = {8, 16, 32, 64};
  brdf::CriticalAngle treatment = brdf::CriticalAngle::kSlide;
};

// The most look-ups that may be asked for.
constexpr int kMostTiltLookups = 64;

struct TiltFit {
  std::vector<paint::TiltedLobes> sets;  // none: the lobes of the paint do as well
  // Mean CIEDE2000 from the map of what the paint's own lobes show, in the lights that sets are fitted in.
  double lobes_de00 = 0;
};

// Fits sets to a map, for a paint whose lobes are `lobes`, with exponents of the basis. There are none where the map is
// one of the aspecular angle, which lobes about the mirror direction can follow; or where the paint's lobes are within
// a visible difference of the map. Bit-identical for any number of threads.
TiltFit fit_tilts(const brdf::ColorMap& map, const paint::LobeFit& lobes, const formats::Basis& basis,
                  const TiltOptions& options);

}  // namespace goniochrome::fit
