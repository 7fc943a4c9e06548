// The verdict of a search on a design: whether paints like it exist, and whether its hue turns like theirs.
// [Shimizu2009] 5.3.5; goniochrome-search(7), "NEAREST PAINT".
#pragma once

#include "library/index.h"
#include "paint/paint.h"

namespace goniochrome::library {

// Tells how far the flop leaves the line through the origin and the face's a*b*, and to which side: it is the hue-shift
// index, with a negative sign where the hue turns clockwise.
double signed_hue_shift(double hue_shift_index, double hue_travel_deg);

struct VerdictLimits {
  double outside = 10;         // mean difference
  double off_radial = 5;       // difference of hue shifts
  double hue_travel_deg = 30;  // difference of hue travels
};

struct Verdict {
  double hue_shift = 0, matched_hue_shift = 0;            // NaN where there is none
  double hue_travel_deg = 0, matched_hue_travel_deg = 0;  // NaN where there is none
  bool outside = false, off_radial = false;
  // The hue turns from face to flop by an angle that is not that of the match; one without a hue does not turn. A turn
  // by half a circle leaves the flop on the hue line of the face, where off_radial does not see it.
  bool turns = false;
};

// `match` is the nearest paint of the index, and mean_de the mean of its color differences from `query`.
Verdict verdict(const paint::Paint& query, const LibraryIndex& index, std::size_t match, double mean_de,
                const VerdictLimits& limits);

}  // namespace goniochrome::library
