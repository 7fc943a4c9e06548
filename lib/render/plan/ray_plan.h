// Which sums and effects of rays a picture is drawn with. goniochrome-plan(7), "Effects of rays".
#pragma once

#include <string>
#include <vector>

#include "render/plan.h"
#include "render/plan/effect_list.h"

namespace goniochrome::render {

// True if an effect is drawn that nobody asked for by name.
bool is_drawn_unasked(const Plan& plan, const std::string& effect);

// The rows of these effects; turns them on in `effects`, which has the other effects of the plan. Effects that need
// another one are off with it: `self`, `bounce` and `floor` need `shadow`. Forcing one of them on forces `shadow` on,
// unless that is forced off.
std::vector<PlanItem> ray_items(const EffectWords& words, const RaySetup& rays, Effects& effects);

// The row of the sums. `by_maps`: whether an engine with prefiltered maps draws the picture.
PlanItem sums_item(const EffectWords& words, const RaySetup& rays, bool by_maps, Effects& effects);

}  // namespace goniochrome::render
