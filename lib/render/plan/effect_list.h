// The effects that can be left out one by one, with the reason why a scene calls for each. Internal to lib/render.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "render/effects.h"
#include "render/internal/visible_point.h"

namespace goniochrome::render {

struct EffectSwitch {
  std::string name;   // "lobe-20"
  std::string group;  // "lobes"
  bool needed = false;
  std::string reason;
  std::function<void(Effects&)> turn_off;
};

// The groups, in the order of the list.
const std::vector<std::string>& effect_groups();

// One switch for each lobe with flake weight, each with gloss weight, and for each other effect. `seen` are visible
// points of the scene.
std::vector<EffectSwitch> effect_switches(const Scene& scene, const Effects& all,
                                          const std::vector<VisiblePoint>& seen);

}  // namespace goniochrome::render
