// The effects that can be left out one by one, with the reason why a scene calls for each of them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "render/effects.h"
#include "render/gbuffer.h"

namespace goniochrome::render {

struct EffectSwitch {
  std::string name;   // "lobe-20"
  std::string group;  // "lobes"
  bool needed = false;
  std::string reason;
  std::function<void(Effects&)> turn_off;
  int needs = -1;              // The effect of this number in the list, without which this one is off as well.
  bool refines = false;        // It only draws another effect finer, so that the reference has no part of it.
  bool beyond_maps = false;    // Engines of prefiltered maps cannot draw it.
  bool left_to_tilts = false;  // Tilted lobes stand for it on some part, and it shows nothing there while they are on.
};

// The name of the effect that corrects maps by sums over the environment.
constexpr const char* kSumsName = "sums";

// The names of the effects of rays, in the order in which plans list them.
const std::vector<std::string>& ray_effect_names();

// One switch for each lobe with flake weight, each with gloss weight, and for each other effect. `seen` are visible
// points of the scene.
std::vector<EffectSwitch> effect_switches(const Scene& scene, const Effects& all,
                                          const std::vector<VisiblePoint>& seen);

}  // namespace goniochrome::render
