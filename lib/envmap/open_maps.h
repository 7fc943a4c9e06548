// Maps that follow from those of a prefiltered environment: the diffuse map under a coat, and each map without the
// bright spots. Bright spots are drawn as lamps, which each horizon cuts exactly. What maps have of them is taken out
// of these, so that maps and lamps together have the light of the environment: in the shape that it really has, apart
// from the horizon. To make these maps takes longer than to read them, so that files keep them.
// goniochrome-rendering(7), "Bright spots" and Coat in image light.
#pragma once

#include <memory>
#include <vector>

#include "envmap/prefiltered.h"

namespace goniochrome::envmap {

// The map of the lobe of this exponent less what the spots give to it. Texels may come out below 0.
CubeMap without_spots(CubeMap map, double exponent, const std::vector<Spot>& spots);

// Variant for the diffuse map or, where `coated`, for coat_diffuse_map().
CubeMap diffuse_without_spots(CubeMap map, bool coated, const std::vector<Spot>& spots);

// Maps that the environment keeps or, where it does not, that are made now. They may share storage with the
// environment, which must outlive them.
using MapPointer = std::shared_ptr<const CubeMap>;
MapPointer plain_map(const PrefilteredLobe& lobe);
// The diffuse map of a base under a coat: light counts with what a coat of brdf::kCoatIndex lets in from where it
// comes, relative to its mean over the hemisphere. Other coats differ from it by 1 part in 100 at most where light
// matters.
MapPointer coat_diffuse_map(const PrefilteredEnvironment& env);
// The maps less what these spots, which are the first ones of the environment, give to them.
MapPointer open_map(const PrefilteredEnvironment& env, const PrefilteredLobe& lobe, std::size_t spots);
MapPointer open_diffuse_map(const PrefilteredEnvironment& env, std::size_t spots);
MapPointer open_coat_diffuse_map(const PrefilteredEnvironment& env, std::size_t spots);

// Makes those of them that the environment lacks.
void keep_open_maps(PrefilteredEnvironment& env);

}  // namespace goniochrome::envmap
