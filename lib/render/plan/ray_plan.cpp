#include "render/plan/ray_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "render/plan/pane_probe.h"
#include "render/plan/path_price.h"
#include "render/plan/spread_pixels.h"

namespace goniochrome::render {

namespace {

constexpr std::size_t kEffects = 3;
// The most at which rays are traced. There are more of them, because most effects of rays show in few places.
constexpr std::size_t kRayProbe = 4096;
// The same allowance for the choice of points as for other effects.
constexpr double kSafety = 0.8;
constexpr RayEffects kAll{true, true, true};

bool RayEffects::*const kFlags[kEffects] = {&RayEffects::shadow, &RayEffects::self, &RayEffects::bounce};

RayEffects nested(RayEffects effects) {
  effects.self = effects.self && effects.shadow;
  effects.bounce = effects.bounce && effects.shadow;
  effects.floor = effects.floor && effects.shadow;
  return effects;
}

RayEffects without(RayEffects effects, std::size_t effect) {
  effects.*kFlags[effect] = false;
  return nested(effects);
}

std::string reason_of(std::size_t effect, const RayProbe& probe, const RayCost& cost, bool over_floor) {
  switch (effect) {
    case 0:
      return fmt::format("rays meet the {} from {:.0f} % of what is seen; {:.0f} samples a point",
                         over_floor ? "mesh or the floor" : "mesh", 100 * probe.blocked_share(), cost.samples);
    case 1:
      return "lobes and mirror see the body";
    default:
      return "light that the body passes on reaches its diffuse parts";
  }
}

struct State {
  RayEffects on;
  std::array<bool, kEffects> forced{}, over_budget{};
  bool named = false;  // whether any effect was asked for by name
};

State forced_state(const RayWishes& wishes) {
  State state;
  std::array<std::optional<bool>, kEffects> forced;
  for (std::size_t i = 0; i < kEffects; ++i) {
    forced[i] = wishes.forced ? wishes.forced(ray_effect_names()[i]) : std::nullopt;
    state.on.*kFlags[i] = forced[i].value_or(wishes.on);
    state.forced[i] = forced[i].has_value();
  }
  state.named = std::ranges::any_of(forced, [](const auto& one) { return one.value_or(false); });
  const bool wanted = forced[1].value_or(false) || forced[2].value_or(false);
  if (wanted && !forced[0]) state.on.shadow = state.forced[0] = true;
  if (forced[0] == std::optional(false)) state.forced.fill(true);
  if (wishes.floor) state.on.shadow = state.on.floor = true;
  state.on = nested(state.on);
  return state;
}

double aim_of(const RayWishes& wishes, const State& state) {
  const RayNoise noise = ray_noise(wishes.tolerance_de00, wishes.open_de00_p95);
  return state.named || !wishes.automatic ? noise.asked_de00 : noise.unasked_de00;
}

// Of the mesh and of the floor beside it.
RayCost cost_of(const RayProbe& probe, const RayWishes& wishes, const RayEffects& effects, double aim_de00,
                const RayLimits& limits = {}) {
  RayCost cost = probe.cost(effects, aim_de00, wishes.visible_points, wishes.samples, limits);
  if (effects.floor && wishes.of_floor != nullptr)
    cost.ms += wishes.of_floor->cost_ms(wishes.floor_pixels, wishes.samples);
  return cost;
}

RayLimits limits_of(const RayWishes& wishes, const State& state) {
  RayLimits limits;
  if (state.named || !wishes.automatic) return limits;
  limits.of_point = kMostUnaskedSamples;
  if (wishes.most_in_all > 0) limits.in_all = wishes.most_in_all;
  return limits;
}

// Leaves out, cheapest to miss first, what all together cannot be seen. What saves no time is drawn.
void drop_unseen(const RayProbe& probe, const RayWishes& wishes, State& state) {
  const auto ms = [&](const RayEffects& effects) { return cost_of(probe, wishes, effects, aim_of(wishes, state)).ms; };
  const RayEffects wanted = state.on;
  std::array<double, kEffects> worth{};
  for (std::size_t i = 0; i < kEffects; ++i) worth[i] = probe.worth(wanted, without(wanted, i)).de00_p95;
  std::array<std::size_t, kEffects> order{};
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return worth[a] < worth[b]; });
  for (const std::size_t i : order) {
    if (!(state.on.*kFlags[i]) || state.forced[i] || (i == 0 && state.on.floor)) continue;
    const RayEffects less = without(state.on, i);
    const bool keeps_forced = !((state.forced[1] && state.on.self) || (state.forced[2] && state.on.bounce)) || i != 0;
    const bool is_unseen = probe.worth(wanted, less).de00_p95 <= kSafety * wishes.tolerance_de00;
    if (keeps_forced && is_unseen && ms(less) < ms(state.on)) state.on = less;
  }
}

// What others need goes last.
void keep_affordable(const RayProbe& probe, const RayWishes& wishes, State& state) {
  const RayLimits limits = limits_of(wishes, state);
  for (const std::size_t i : {std::size_t{2}, std::size_t{1}, std::size_t{0}}) {
    if (cost_of(probe, wishes, state.on, aim_of(wishes, state), limits).ms <= wishes.budget_ms) return;
    if (!(state.on.*kFlags[i]) || state.forced[i] || (i == 0 && state.on.floor)) continue;
    state.on = without(state.on, i);
    state.over_budget[i] = true;
  }
}

Decision decision_of(const State& state, std::size_t i) {
  const bool on = state.on.*kFlags[i];
  if (state.forced[i]) return on ? Decision::kForcedOn : Decision::kForcedOff;
  if (state.over_budget[i]) return Decision::kOverBudget;
  return on ? Decision::kDrawn : Decision::kDropped;
}

}  // namespace

const std::vector<std::string>& ray_effect_names() {
  static const std::vector<std::string> names = {"shadow", "self", "bounce", "floor"};
  return names;
}

RayNoise ray_noise(double tolerance_de00, double open_de00_p95) {
  return {kRayNoiseShare * tolerance_de00, kRayNoiseShare * std::max(tolerance_de00, open_de00_p95)};
}

RayChoice no_rays(const std::string& reason, bool refused) {
  RayChoice choice;
  for (std::size_t i = 0; i < kEffects; ++i) {
    PlanItem item;
    item.effect = ray_effect_names()[i], item.reason = reason;
    if (refused) {
      item.needed = true, item.decision = Decision::kForcedOff;
      item.de00_p95 = item.cost_ms = std::numeric_limits<double>::quiet_NaN();
    }
    choice.items.push_back(std::move(item));
  }
  return choice;
}

RayChoice ray_choice(const RayProbe& probe, const RayWishes& wishes) {
  if (probe.free() && !wishes.floor) return no_rays("no ray meets the mesh");
  State state = forced_state(wishes);
  const RayEffects wanted = state.on;
  if (wishes.automatic) drop_unseen(probe, wishes, state);
  if (wishes.budget_ms > 0) keep_affordable(probe, wishes, state);

  RayChoice choice;
  choice.effects = state.on;
  choice.aim_de00 = aim_of(wishes, state);
  const RayLimits limits = limits_of(wishes, state);
  const auto cost = [&](const RayEffects& effects) { return cost_of(probe, wishes, effects, choice.aim_de00, limits); };
  choice.cost = cost(state.on);
  if (limits.of_point == kMostUnaskedSamples) choice.most_samples = kMostUnaskedSamples;
  if (state.on.any()) {
    if (limits.of_point == kMostUnaskedSamples) choice.most_in_all = wishes.most_in_all;
    choice.noise_de00 = choice.aim_de00 * choice.cost.noise;
    const double named_de00 = ray_noise(wishes.tolerance_de00, wishes.open_de00_p95).asked_de00;
    choice.named_ms = cost_of(probe, wishes, state.on, named_de00).ms;
  }
  choice.left_out_de00_p95 = state.on == wanted ? 0 : probe.worth(wanted, state.on).de00_p95;
  RayEffects everything = kAll;
  everything.floor = wishes.floor;
  const RayCost all = cost(everything);
  for (std::size_t i = 0; i < kEffects; ++i) {
    PlanItem item;
    const RayEffects less = without(everything, i);
    const Worth worth = probe.worth(everything, less);
    item.effect = ray_effect_names()[i], item.needed = true, item.reason = reason_of(i, probe, all, wishes.floor);
    item.de00_p95 = worth.de00_p95, item.standard_error = worth.standard_error;
    item.cost_ms = std::max(0.0, all.ms - cost(less).ms);
    item.on = state.on.*kFlags[i], item.decision = decision_of(state, i);
    choice.items.push_back(std::move(item));
  }
  return choice;
}

namespace {

// The floor's row of the plan, and whether it is drawn.
struct FloorChoice {
  PlanItem item;
  bool on = false;
};

std::optional<bool> forced_by(const Words& words, const std::string& name) {
  std::optional<bool> forced;
  for (const auto& [word, on] : words.forced)
    if (word == name || word == "rays") forced = on;
  return forced;
}

FloorChoice no_floor(const std::string& reason) {
  FloorChoice choice;
  choice.item.effect = ray_effect_names()[kEffects];
  choice.item.reason = reason;
  return choice;
}

// Of the mesh, which it lights, and of the picture beside it, whichever changes more.
FloorChoice floor_choice(const RayProbe& probe, const FloorProbe& beside, const RayWishes& wishes, bool forced) {
  FloorChoice choice = no_floor("the mesh stands on the ground of the environment, which lights it from below");
  PlanItem& item = choice.item;
  item.needed = true;
  const Worth on_mesh = probe.floor_worth().value_or(Worth{}), around = beside.worth();
  const Worth& worth = on_mesh.de00_p95 > around.de00_p95 ? on_mesh : around;
  item.de00_p95 = worth.de00_p95, item.standard_error = worth.standard_error;
  const double aim = ray_noise(wishes.tolerance_de00, wishes.open_de00_p95).unasked_de00;
  RayEffects all = kAll;
  const RayLimits limits = limits_of(wishes, forced_state(wishes));
  const double mesh_ms = probe.cost(all, aim, wishes.visible_points, wishes.samples, limits).ms;
  const double without_ms = probe.cost_without_floor(aim, wishes.visible_points, wishes.samples, limits).ms;
  const double beside_ms = beside.cost_ms(wishes.floor_pixels, wishes.samples);
  item.cost_ms = std::max(0.0, mesh_ms + beside_ms - without_ms);
  item.decision = forced ? Decision::kForcedOn : Decision::kDrawn;
  if (!forced && wishes.automatic && worth.de00_p95 <= kSafety * wishes.tolerance_de00)
    item.decision = Decision::kDropped;
  if (!forced && wishes.budget_ms > 0 && mesh_ms + beside_ms > wishes.budget_ms) item.decision = Decision::kOverBudget;
  item.on = choice.on = item.decision == Decision::kForcedOn || item.decision == Decision::kDrawn;
  return choice;
}

}  // namespace

RayChoice planned_rays(const Scene& scene, const std::vector<std::shared_ptr<const Gbuffer>>& gbuffers,
                       const PlanRequest& request, const Words& words, const RayContext& rays, double points_drawn,
                       double open_de00,
                       const std::function<std::vector<color::Rgb>(const std::vector<VisiblePoint>&)>& colors) {
  if (rays.transport == nullptr) {
    RayChoice choice;
    if (rays.absent.empty()) return choice;
    choice = no_rays(rays.absent, rays.refused);
    choice.items.push_back(no_floor(rays.absent).item);
    return choice;
  }
  std::vector<VisiblePoint> points;
  std::vector<RayPoint> ray_points;
  const std::vector<ProbePixel> pixels_seen = spread_pixels(gbuffers, kRayProbe);
  for (const auto& [gbuffer, x, y] : pixels_seen) {
    points.push_back(gbuffer->point(x, y, {}, scene.mesh));
    ray_points.push_back(ray_point(rays.transport->rays(), *scene.mesh, *gbuffer, x, y));
  }
  // Points behind panes count as if nothing were before them.
  const PaneProbe panes = pane_probe(rays.whole, scene, pixels_seen);
  points.insert(points.end(), panes.behind.begin(), panes.behind.end());
  ray_points.insert(ray_points.end(), panes.ray_points.begin(), panes.ray_points.end());
  if (!pixels_seen.empty())
    points_drawn *= static_cast<double>(points.size()) / static_cast<double>(pixels_seen.size());
  const std::vector<color::Rgb> base = colors(points);
  RayWishes wishes;
  wishes.on = words.start != Start::kNone;
  wishes.automatic = words.start == Start::kAuto;
  wishes.forced = [&](const std::string& name) { return forced_by(words, name); };
  wishes.open_de00_p95 = open_de00;
  wishes.tolerance_de00 = request.tolerance_de00, wishes.budget_ms = request.budget_ms;
  wishes.most_in_all = request.most_ray_samples;
  wishes.visible_points = points_drawn / request.samples, wishes.samples = request.samples;
  ProbeSetting setting;
  setting.transport = rays.transport;
  setting.white_luminance = request.white_luminance;
  setting.bounces = rays.bounces, setting.seed = rays.seed;
  setting.visible_points = static_cast<double>(gbuffers.size()) * points_drawn / request.samples;
  double shown = 0;
  for (const auto& g : gbuffers) shown += static_cast<double>(g->data.size() / 4);
  const auto of_picture = [&](const FloorPixels& pixels) {
    return request.pixels > 0 && shown > 0 ? pixels.count * request.pixels / shown : pixels.count;
  };
  const auto with_path_price = [&](RayChoice choice) {
    const Transport* alone = open_de00 > request.tolerance_de00 && rays.alone ? rays.alone() : nullptr;
    if (alone == nullptr) return choice;
    constexpr std::size_t kPixels = 32;
    PathWork work;
    work.mesh = probe_pixels(gbuffers, kPixels), work.mesh_pixels = wishes.visible_points;
    const FloorPixels floor = floor_pixels(*alone, scene, rays.environment, gbuffers, kPixels);
    for (const FloorPoint& point : floor.points) work.floor.push_back(point.pixel);
    work.floor_pixels = of_picture(floor);
    work.pixel_samples = request.samples;
    work.white_luminance = request.white_luminance, work.tolerance_de00 = request.tolerance_de00;
    work.bounces = rays.bounces, work.seed = rays.seed;
    const PathPrice price = path_price(*alone, work);
    choice.path_ms = price.ms, choice.path_samples = price.samples;
    choice.path_in_all = price.samples * (work.mesh_pixels + work.floor_pixels);
    return choice;
  };

  const bool off = forced_by(words, "shadow") == std::optional(false);
  FloorChoice floor = no_floor(off ? "the floor needs the effect shadow" : rays.no_floor);
  if (rays.over_floor != nullptr && !off) {
    setting.transport = rays.over_floor, setting.without_floor = rays.transport;
    constexpr std::size_t kFloorPixels = 384;
    const FloorPixels pixels = floor_pixels(*rays.over_floor, scene, rays.environment, gbuffers, kFloorPixels);
    const RayProbe probe = RayProbe::traced(setting, ray_points, base);
    const FloorProbe beside(*rays.over_floor, request.white_luminance, pixels);
    wishes.floor_pixels = of_picture(pixels);
    wishes.of_floor = &beside;
    floor = floor_choice(probe, beside, wishes, rays.floor_forced);
    if (floor.on) {
      wishes.floor = true;
      RayChoice choice = with_path_price(ray_choice(probe, wishes));
      choice.items.push_back(std::move(floor.item));
      return choice;
    }
    setting.transport = rays.transport, setting.without_floor = nullptr;
    wishes.of_floor = nullptr;
  }
  RayChoice choice = with_path_price(ray_choice(RayProbe::traced(setting, ray_points, base), wishes));
  choice.items.push_back(std::move(floor.item));
  return choice;
}

}  // namespace goniochrome::render
