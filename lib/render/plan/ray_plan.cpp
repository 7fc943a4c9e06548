#include "render/plan/ray_plan.h"

#include <algorithm>
#include <array>
#include <optional>

#include "render/path/open_residual.h"
#include "render/path/ray_correction.h"

namespace goniochrome::render {

namespace {

// The most samples of a point that are drawn for effects that nobody asked for by name. Most points get far fewer.
constexpr int kMostUnaskedSamples = 1024;

constexpr std::size_t kFloor = 3;
bool RayEffects::* const kFlags[] = {&RayEffects::shadow, &RayEffects::self, &RayEffects::bounce, &RayEffects::floor};
const char* const kReasons[] = {"rays tell where the mesh is in the way of light",
                                "lobes and mirror see the body where it is in the way of light",
                                "light that the body passes on reaches its diffuse parts",
                                "the mesh stands on the ground of the environment, which lights it from below"};

// The sums have what these effects draw, so that a picture without one of them would show it nevertheless.
bool lacks_what_sums_have(const EffectWords& words) {
  return std::ranges::any_of(words.forced, [](const auto& word) {
    return !word.second && (word.first == "horizon" || word.first == "fresnel");
  });
}

}  // namespace

bool is_drawn_unasked(const Plan& plan, const std::string& effect) {
  const auto item = std::ranges::find(plan.items, effect, &PlanItem::effect);
  return item != plan.items.end() && item->decision == Decision::kDrawn;
}

std::vector<PlanItem> ray_items(const EffectWords& words, const RaySetup& rays, Effects& effects) {
  constexpr std::size_t kEffects = std::size(kFlags);
  const std::vector<std::string>& names = ray_effect_names();
  std::array<std::optional<bool>, kEffects> forced;
  for (std::size_t i = 0; i < kEffects; ++i) forced[i] = words.forced_on(names[i], i != kFloor ? "rays" : "");
  const bool named =
      std::any_of(forced.begin(), forced.begin() + kFloor, [](const auto& one) { return one.value_or(false); });
  if (rays.has_floor() && rays.floor_forced) forced[kFloor] = true;
  if (!forced[0] && (forced[1].value_or(false) || forced[2].value_or(false) || forced[kFloor].value_or(false)))
    forced[0] = true;
  if (forced[0] == std::optional(false)) forced.fill(false);

  std::vector<PlanItem> items;
  for (std::size_t i = 0; i < kEffects; ++i) {
    const bool there = rays.absent.empty() && (i != kFloor || rays.has_floor());
    PlanItem item = unmeasured(names[i], there ? kReasons[i] : rays.absent.empty() ? rays.no_floor : rays.absent);
    item.needed = there || (rays.refused && i != kFloor);
    item.on = there && forced[i].value_or(words.start != Start::kNone);
    item.on = item.on && (i == 0 || effects.rays.shadow);
    item.decision = decision_of(item.needed, item.on, rays.refused || forced[i].has_value());
    effects.rays.*kFlags[i] = item.on;
    items.push_back(std::move(item));
  }
  const bool limited = words.start == Start::kAuto && !named;
  if (limited) effects.most_ray_samples = kMostUnaskedSamples;
  return items;
}

PlanItem sums_item(const EffectWords& words, const RaySetup& rays, bool by_maps, Effects& effects) {
  if (!effects.environment) return unmeasured(kSumsName, "no image light");
  const std::optional<bool> forced = words.forced_on(kSumsName);
  PlanItem item = unmeasured(kSumsName, "sums over the environment correct the diffuse part and wide lobes");
  if (rays.environment == nullptr || !by_maps) {
    item.reason = by_maps ? "drawn where rays are traced, or where sums are named with a plus"
                          : "the engine looks nothing up in prefiltered maps";
    if (forced == std::optional(false)) item.needed = true, item.decision = Decision::kForcedOff;
    return item;
  }
  item.needed = OpenResidual::applies(effects);
  if (!item.needed) {
    item.reason = "the diffuse map is exact, and there are no lobes that the horizon cuts";
    return item;
  }
  item.on = forced.value_or(words.start != Start::kNone);
  item.decision = decision_of(true, item.on, forced.has_value());
  if (item.on && lacks_what_sums_have(words)) {
    item.on = false, item.decision = Decision::kDropped;
    item.reason += "; sums have the effects horizon and fresnel, which are not drawn";
  }
  effects.sums = item.on;
  return item;
}

}  // namespace goniochrome::render
