// Which effects of rays a picture is drawn with. goniochrome-theory(7), PLAN, Effects of rays.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "render/plan.h"
#include "render/plan/ray_probe.h"

namespace goniochrome::render {

// The part of the tolerance that the noise of these effects may take, as one standard deviation at 95 of 100 points.
// The error of a point may be several times its standard deviation, so that this alone does not keep the whole picture
// within the tolerance: --check-against truth tells.
constexpr double kRayNoiseShare = 0.5;

// The names of the effects, in the order in which plans list them.
const std::vector<std::string>& ray_effect_names();

// What decides, beside what the effects are worth.
struct RayWishes {
  bool on = true;         // whether what is not forced is on to begin with
  bool automatic = true;  // whether it may be left out for being unseen
  std::function<std::optional<bool>(const std::string& name)> forced;
  double tolerance_de00 = 0.5;
  double budget_ms = 0;  // of one frame's rays; 0: none
  double visible_points = 0;
  int samples = 1;
};

struct RayChoice {
  std::vector<PlanItem> items;
  RayEffects effects;
  double left_out_de00_p95 = 0;  // of all that is left out and was not forced off
  RayCost cost;                  // of what is drawn
};

// Effects that need another one are off with it: `self` and `bounce` need `shadow`. Forcing one of them on forces
// `shadow` on, unless that is forced off.
RayChoice ray_choice(const RayProbe& probe, const RayWishes& wishes);

// Where rays cannot be traced: all effects off, for this reason.
RayChoice no_rays(const std::string& reason);

}  // namespace goniochrome::render
