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

// By how much the paint may be off at each export angle, CIEDE2000, because of light that the search does not know. No
// two regions of a picture have as much of it, so that they disagree about the paint. They may share the light that a
// floor takes away, of which the half that faces up has little: four standard errors by places, or two by halves, where
// these are more.
std::vector<double> told_by_regions(const LobeSearch& search, const FoundPaint& found, const formats::Basis& basis,
                                    double coat_index, const Regions& places, const Regions& halves);

}  // namespace goniochrome::sketch
