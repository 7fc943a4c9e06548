// How far regions of one picture disagree about the paint, which tells how far light that the search does not know
// leads it. goniochrome-theory(7), SKETCH FITTING.
#pragma once

#include <cstdint>
#include <vector>

#include "sketch/internal/sketch_search.h"

namespace goniochrome::sketch {

// The numbers of the samples in each region.
using Regions = std::vector<std::vector<std::size_t>>;

// Eight regions of equally many samples, which are the pixels at `places` of a picture of that width.
Regions regions_of_places(const std::vector<std::uint32_t>& places, int width);

// Two: the half of the samples whose normals point down most, or up least, and the other half. `up` has the vertical
// component of each normal.
Regions halves_by_height(const std::vector<double>& up);

// The paints that are found without one region each, from one that was found in all of them.
std::vector<PaintWeights> without_each_region(const LobeSearch& search, const FoundPaint& found, const Regions& regions,
                                              LobeSearch::Gloss gloss);

// The standard error of a paint found at each export angle, CIEDE2000, by the jackknife [Miller1974] of the paints that
// are found without one region each.
std::vector<double> apart_by_regions(const formats::Basis& basis, const PaintWeights& found,
                                     const std::vector<PaintWeights>& without, double coat_index);

}  // namespace goniochrome::sketch
