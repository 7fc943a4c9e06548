// The maps of the environment as engines look them up. Maps that are looked up in one direction are brought to few face
// sizes, so that one set of texel addresses serves many lobes. goniochrome-rendering(7), "Engines".
#pragma once

#include <vector>

#include "base/result.h"
#include "envmap/open_maps.h"
#include "render/effects.h"

namespace goniochrome::render {

// Maps that are sampled together, all with faces of one size.
struct MapClass {
  int size = 0;
  std::vector<int> slots;                // of the weight table, ascending
  std::vector<envmap::MapPointer> maps;  // one for each slot, to be brought to that size by at_size()
  bool shifted = false;                  // a single lobe, met by r + s n
};

struct SceneMaps {
  MapClass diffuse;             // met by the normal; with the effect `coat` the coat's diffuse map as well
  std::vector<MapClass> lobes;  // met by the mirror direction; small faces first
  MapClass mirror;              // met by the mirror direction, and by rays that miss the mesh
};

// The lobes of the effects (by number) that share one direction and one face size; small faces first, after those that
// have a direction of their own. Lobes that the environment lacks are in none.
struct LobeClass {
  std::vector<std::size_t> lobes;
  bool shifted = false;
};
std::vector<LobeClass> lobe_classes(const envmap::PrefilteredEnvironment& env, const Effects& effects);

// The maps of the scene's environment that the effects need, without the bright spots that they cut one by one; the
// mirror part keeps these. Error: a lobe or the mirror part that the environment lacks, with the command that makes it.
// The maps may be those of the environment, which must outlive them.
Result<SceneMaps> scene_maps(const Scene& scene, const Effects& effects);
// By bilinear interpolation between its own texels.
envmap::MapPointer at_size(envmap::MapPointer map, int size);

}  // namespace goniochrome::render
