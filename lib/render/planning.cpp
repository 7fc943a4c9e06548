#include "render/planning.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "base/clock.h"
#include "base/text.h"
#include "render/cpu/cpu_engine.h"
#include "render/exact.h"
#include "render/internal/seen.h"
#include "render/internal/tilt_table.h"
#include "render/internal/wear.h"
#include "render/panes.h"
#include "render/path/ray_correction.h"
#include "render/plan/effect_list.h"
#include "render/plan/highlights.h"
#include "render/plan/ray_plan.h"
#include "render/plan/sparkle_plan.h"
#include "render/scene_effects.h"
#include "render/surface_layer.h"

namespace goniochrome::render {

namespace {

// The probe sees 95 % of some hundred points; the picture's own percentile is that far off at most times.
constexpr double kSafetyOfMaps = 0.8;

// Visible points that a plan is made from.
constexpr std::size_t kProbe = 512;

// Turns off what draws nothing without lobes, or without gloss.
void leave_out_idle(Effects& effects) {
  const auto used = [](const auto& use) { return use.directional_diffuse || use.gloss; };
  const bool lobes = std::ranges::any_of(effects.lobes, used);
  effects.fresnel = effects.fresnel && (effects.mirror || std::ranges::any_of(effects.lobes, &Effects::LobeUse::gloss));
  effects.horizon = effects.horizon && lobes;
  if (!effects.horizon) effects.spots = 0;
  effects.anisotropy = effects.anisotropy && lobes;
  effects.texture_filter = effects.texture_filter && effects.texture;
}

// Lobes without any weight are not drawn, nor their maps uploaded.
void tidy(Effects& effects) {
  leave_out_idle(effects);
  std::erase_if(effects.lobes, [](const Effects::LobeUse& use) { return !use.directional_diffuse && !use.gloss; });
}

// The scene with each paint once, and the points' parts renumbered.
struct Compact {
  Scene scene;
  std::vector<VisiblePoint> points;
};
Compact compacted(const Scene& scene, const std::vector<VisiblePoint>& points) {
  Compact compact{scene, points};
  compact.scene.paints.clear(), compact.scene.gloss_deg.clear(), compact.scene.anisotropy.clear();
  std::vector<std::size_t> first;
  std::vector<int> place(scene.paints.size());
  for (std::size_t part = 0; part < scene.paints.size(); ++part) {
    const auto same = std::ranges::find_if(first, [&](std::size_t f) { return same_wear(scene, f, part); });
    place[part] = static_cast<int>(same - first.begin());
    if (same != first.end()) continue;
    first.push_back(part);
    compact.scene.paints.push_back(scene.paints[part]);
    compact.scene.gloss_deg.push_back(gloss_deg_of(scene, part));
    compact.scene.anisotropy.push_back(anisotropy_of(scene, part));
  }
  for (VisiblePoint& point : compact.points) point.part = place[static_cast<std::size_t>(point.part)];
  return compact;
}

// Shades the probe with any choice of effects.
struct Prober {
  std::size_t shown;  // the first points, which are those of the picture; highlight_points() follow
  const Scene& scene;
  const Effects& all;
  const std::vector<EffectSwitch>& switches;
  const std::vector<VisiblePoint>& points;
  const std::vector<VisiblePoint>& seen;  // the same, with the parts of the whole scene
  double white;
  CpuEngine& engine;
  CpuEngine* component_wise;  // with the plain product of colors; null where no other product is left out
  std::map<std::vector<bool>, std::vector<color::Rgb>> known = {};

  Effects effects(const std::vector<bool>& on) const {
    Effects chosen = all;
    for (std::size_t i = 0; i < switches.size(); ++i) {
      if (!on[i]) switches[i].turn_off(chosen);
    }
    leave_out_idle(chosen);
    return chosen;
  }

  // Kept, since the same choices are tried again and again. The result holds as long as the prober.
  const std::vector<color::Rgb>& colors(std::vector<bool> on) {
    for (std::size_t i = 0; i < on.size(); ++i) on[i] = on[i] || !switches[i].needed;
    const auto [found, is_new] = known.try_emplace(std::move(on));
    if (!is_new) return found->second;
    const Effects chosen = effects(found->first);
    CpuEngine& by = chosen.reflection || component_wise == nullptr ? engine : *component_wise;
    by.load_paints(scene, chosen);
    found->second = by.colors(points);
    if (scene.layer != nullptr) scene.layer->add(seen, chosen, found->second);
    return found->second;
  }

  double difference(const std::vector<color::Rgb>& a, const std::vector<color::Rgb>& b) const {
    std::vector<double> de00;
    for (std::size_t i = 0; i < shown; ++i) de00.push_back(seen_difference(a[i], b[i], white));
    return percentile_95(std::move(de00));
  }

  // The largest difference at the points of the picture and at highlights, which may lie between them.
  double most(const std::vector<color::Rgb>& a, const std::vector<color::Rgb>& b) const {
    double largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, seen_difference(a[i], b[i], white));
    return largest;
  }
};

// The effects that are on while the plan is made, and those of them that may be changed.
struct Choice {
  std::vector<bool> on, forced;
};

// An effect that needs another one is off without it.
void settle(const std::vector<EffectSwitch>& switches, std::vector<bool>& on) {
  for (std::size_t i = 0; i < switches.size(); ++i)
    if (switches[i].needs >= 0 && !on[static_cast<std::size_t>(switches[i].needs)]) on[i] = false;
}

Choice forced_choice(const EffectWords& words, const std::vector<EffectSwitch>& switches) {
  Choice choice{std::vector<bool>(switches.size()), std::vector<bool>(switches.size(), false)};
  for (std::size_t i = 0; i < switches.size(); ++i) {
    const std::optional<bool> forced = words.forced_on(switches[i].name, switches[i].group);
    choice.on[i] = switches[i].needed && forced.value_or(words.start != Start::kNone);
    choice.forced[i] = forced.has_value();
  }
  // A forced effect turns on what it needs, unless that is forced off.
  for (std::size_t i = switches.size(); i-- > 0;) {
    if (switches[i].needs < 0 || !choice.forced[i] || !choice.on[i]) continue;
    const auto needed = static_cast<std::size_t>(switches[i].needs);
    if (!choice.forced[needed]) choice.on[needed] = choice.forced[needed] = true;
  }
  settle(switches, choice.on);
  return choice;
}

// True if tilted lobes are drawn.
bool tilted(const std::vector<EffectSwitch>& switches, const std::vector<bool>& on) {
  for (std::size_t i = 0; i < switches.size(); ++i)
    if (switches[i].group == "tilts" && switches[i].needed && on[i]) return true;
  return false;
}

// Leaves out, cheapest to miss first, what all together cannot be seen: at 95 of 100 points, nor at any highlight.
void drop_unseen(Prober& prober, const std::vector<EffectSwitch>& switches, const std::vector<PlanItem>& items,
                 double tolerance, Choice& choice) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (switches[i].left_to_tilts && tilted(switches, choice.on)) continue;
    if (choice.on[i] && !choice.forced[i] && items[i].de00_p95 <= tolerance) order.push_back(i);
  }
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return items[i].de00_p95; });
  // The finest set of tilted lobes comes first: what stands for it is then judged with the rest.
  const auto is_tilts = [&](std::size_t i) { return switches[i].group == "tilts"; };
  const auto rest = std::stable_partition(order.begin(), order.end(), is_tilts);
  std::sort(order.begin(), rest, std::greater<>());
  const std::vector<color::Rgb>& wanted = prober.colors(choice.on);
  for (const std::size_t i : order) {
    const std::vector<bool> before = choice.on;
    choice.on[i] = false;
    settle(switches, choice.on);
    const std::vector<color::Rgb>& colors = prober.colors(choice.on);
    if (prober.difference(wanted, colors) > kSafetyOfMaps * tolerance || prober.most(wanted, colors) > tolerance)
      choice.on = before;
  }
}

// The plan for an engine that draws everything and does without prefiltered maps: there is nothing to choose, and
// nothing to try it out by.
Plan plan_of_everything(const Scene& scene, const Effects& all, const std::vector<VisiblePoint>& probe,
                        const EngineInfo& engine) {
  Plan plan;
  const auto add = [&](const std::string& effect, bool needed, const std::string& reason) {
    plan.items.push_back(unmeasured(effect, reason, needed));
    plan.items.back().on = needed, plan.items.back().decision = decision_of(needed, needed, false);
  };
  for (const EffectSwitch& effect : effect_switches(scene, all, probe)) add(effect.name, effect.needed, effect.reason);
  plan.items.push_back(sparkle_left_out(scene, engine.name));
  for (const std::string& name : ray_effect_names()) {
    const bool there = name != "floor" || scene.ground.has_value();
    add(name, there, there ? "drawn by every path" : "no floor is asked for");
  }
  plan.effects = all;
  plan.engine = engine.name;
  plan.engine_reason = "as asked: it draws every effect by rays alone, without prefiltered maps";
  return plan;
}

// The engine that is asked for, or the first that draws by prefiltered maps.
const EngineInfo& chosen_engine(const std::vector<const Engine*>& engines, const std::optional<std::string>& asked) {
  const auto wanted = std::ranges::find_if(
      engines, [&](const Engine* engine) { return asked ? *asked == engine->info().name : engine->info().is_planned; });
  return (wanted != engines.end() ? *wanted : engines.front())->info();
}

// The change by leaving out each effect alone. Nothing is known of light that maps cannot show, nor of surfaces behind
// panes. The product of colors is baked into maps, and as fast as the plain one: it is tried out where it is off by
// name.
std::vector<PlanItem> measured_items(Prober& prober, const std::vector<EffectSwitch>& switches) {
  std::vector<bool> on(switches.size(), true);
  const std::vector<color::Rgb>& full = prober.colors(on);
  std::vector<PlanItem> items;
  for (std::size_t i = 0; i < switches.size(); ++i) {
    PlanItem& item = items.emplace_back(unmeasured(switches[i].name, switches[i].reason, switches[i].needed));
    const bool is_untried = switches[i].group == "operator" && prober.component_wise == nullptr;
    if (switches[i].beyond_maps || switches[i].group == "panes" || is_untried) continue;
    on[i] = !item.needed;
    item.de00_p95 = item.needed ? prober.difference(full, prober.colors(on)) : 0;
    on[i] = true;
  }
  return items;
}

}  // namespace

std::vector<ProbePixel> probe_pixels(const std::vector<std::shared_ptr<const Gbuffer>>& gbuffers, std::size_t count) {
  std::size_t visible = 0;
  for (const auto& g : gbuffers) {
    for (std::size_t i = 3; i < g->data.size(); i += 4) visible += g->data[i] != 0 ? 1 : 0;
  }
  // Every n-th visible point, row by row; a stride that shares no factor with common widths keeps columns apart.
  const std::size_t stride = std::max<std::size_t>(1, visible / count) | 1;
  std::vector<ProbePixel> pixels;
  std::size_t met = stride / 2;
  for (const auto& g : gbuffers) {
    for (std::size_t i = 0; 4 * i + 3 < g->data.size(); ++i) {
      if (g->data[4 * i + 3] == 0 || ++met % stride != 0) continue;
      pixels.push_back({g.get(), static_cast<int>(i) % g->width, static_cast<int>(i) / g->width, {}});
    }
  }
  return pixels;
}

std::vector<VisiblePoint> probe_points(const std::vector<ProbePixel>& pixels, const Scene& scene, int samples) {
  std::vector<VisiblePoint> points;
  for (const auto& [gbuffer, x, y, shown] : pixels) {
    points.push_back(gbuffer->point(x, y, {}, scene.mesh));
    if (scene.layer != nullptr && scene.layer->textured())
      scene.layer->put_places(*gbuffer, x, y, 1 / std::sqrt(samples), points.back());
  }
  return points;
}

Scene seen_scene(const Scene& scene, const std::vector<std::shared_ptr<const Gbuffer>>& gbuffers) {
  if (has_panes(scene)) return scene;
  std::vector<bool> seen(scene.paints.size(), false);
  for (const auto& g : gbuffers) {
    for (std::size_t i = 3; i < g->data.size(); i += 4) {
      if (g->data[i] != 0) seen[static_cast<std::size_t>(std::abs(g->data[i])) - 1] = true;
    }
  }
  Scene result = scene;
  for (std::size_t part = 0; part < seen.size(); ++part) {
    if (seen[part]) continue;
    result.paints[part] = {};
    if (part < result.anisotropy.size()) result.anisotropy[part] = {};
  }
  return result;
}

Result<Plan> make_plan(const Scene& scene, const std::vector<std::shared_ptr<const Gbuffer>>& gbuffers,
                       const PlanRequest& request, const std::vector<const Engine*>& engines, const RaySetup& rays,
                       CpuEngine& tried) {
  const EffectWords& words = request.effects;
  Effects all = effects_of(scene);
  all.tolerance_de00 = request.tolerance_de00;
  std::vector<ProbePixel> pixels = probe_pixels(gbuffers, kProbe);
  const std::vector<VisiblePoint> probe = probe_points(pixels, scene, request.samples);
  const EngineInfo& engine = chosen_engine(engines, request.engine);
  if (engine.traces_rays) return plan_of_everything(scene, all, probe, engine);
  Effects on_mesh = all;
  on_mesh.background = Background::kNone;
  GONIO_TRY(tried.load(scene, on_mesh));
  const Stopwatch clock;
  const std::vector<EffectSwitch> switches = effect_switches(scene, all, probe);
  Choice choice = forced_choice(words, switches);
  CpuEngine plain;
  const auto product = std::ranges::find(switches, "operator", &EffectSwitch::group) - switches.begin();
  const bool tries_plain = all.reflection && !choice.on[static_cast<std::size_t>(product)];
  on_mesh.reflection = false;
  if (tries_plain) GONIO_TRY(plain.load(scene, on_mesh));
  std::vector<VisiblePoint> points = probe;
  const std::vector<VisiblePoint> highlights = highlight_points(scene, all, probe);
  points.insert(points.end(), highlights.begin(), highlights.end());
  const Compact compact = compacted(scene, points);
  const double white = request.white_luminance;
  Prober prober{
      probe.size(), compact.scene, all, switches, compact.points, points, white, tried, tries_plain ? &plain : nullptr};
  Plan plan;
  plan.items = measured_items(prober, switches);
  for (std::size_t i = 0; i < switches.size() && engine.is_planned; ++i)
    if (switches[i].beyond_maps) choice.on[i] = false, choice.forced[i] = true;
  // Surfaces behind panes are at none of the points.
  if (words.start == Start::kAuto && engine.is_planned && !has_panes(scene))
    drop_unseen(prober, switches, plan.items, request.tolerance_de00, choice);

  const std::vector<bool> everything(switches.size(), true);
  plan.de00_p95 = prober.difference(prober.colors(everything), prober.colors(choice.on));
  plan.effects = prober.effects(choice.on);
  tidy(plan.effects);
  leave_to_tilts(scene, plan.effects);
  plan.engine = engine.name;
  plan.engine_reason = request.engine ? "as asked" : "prefiltered maps, and rays where the mesh is in the way of light";
  for (std::size_t i = 0; i < switches.size(); ++i) {
    PlanItem& item = plan.items[i];
    item.on = choice.on[i];
    item.decision = decision_of(item.needed, item.on, choice.forced[i]);
    if (!switches[i].needed || !switches[i].beyond_maps || !engine.is_planned) continue;
    item.decision = Decision::kDropped;
    item.reason += "; prefiltered maps cannot show it, the engines integral and path do";
  }
  const std::vector<color::Rgb>& shown = prober.colors(choice.on);
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i].shown = shown[i];
  plan.items.push_back(engine.is_planned ? sparkle_item(scene, pixels, request, plan.effects)
                                         : sparkle_left_out(scene, engine.name));
  plan.items.push_back(sums_item(words, rays, engine.is_planned, plan.effects));
  for (PlanItem& item : ray_items(words, rays, plan.effects)) plan.items.push_back(std::move(item));
  plan.time_ms = 1000 * clock.elapsed_s();
  return plan;
}

namespace {

PlanItem* row_of(Plan& plan, const std::string& effect) {
  const auto found = std::ranges::find(plan.items, effect, &PlanItem::effect);
  return found != plan.items.end() ? &*found : nullptr;
}

}  // namespace

void add_truth(Plan& plan, const Scene& scene, const std::vector<VisiblePoint>& points, const envmap::Environment* env,
               double white_luminance, std::vector<ProbePixel> pixels) {
  const Effects all = effects_of(scene);
  const std::vector<EffectSwitch> switches = effect_switches(scene, all, points);
  // Facets take the place of gloss lobes: what one of these is worth shows where lobes are drawn.
  Effects by_lobes = all;
  by_lobes.satin = false;
  const std::vector<color::Rgb> full = exact_radiance(points, scene, all, env),
                                lobes = all.satin ? exact_radiance(points, scene, by_lobes, env) : full;
  for (std::size_t i = 0; i < switches.size(); ++i) {
    if (!switches[i].needed || switches[i].refines) continue;  // the reference has no sets
    Effects without = by_lobes;
    switches[i].turn_off(without);
    const std::vector<color::Rgb>& with = switches[i].beyond_maps ? full : lobes;
    const std::vector<color::Rgb> colors = exact_radiance(points, scene, without, env);
    std::vector<double> de00;
    for (std::size_t j = 0; j < with.size(); ++j) de00.push_back(seen_difference(with[j], colors[j], white_luminance));
    plan.items[i].truth_de00_p95 = percentile_95(std::move(de00));
  }
  PlanItem* flakes = row_of(plan, kSparkleName);
  if (flakes == nullptr || std::isnan(flakes->de00_p95) || pixels.empty()) return;
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i].shown = full[i];
  flakes->truth_de00_p95 = sparkle_truth(scene, all, pixels, white_luminance);
}

namespace {

void add_finding(double de00_p95, bool stopped, PlanItem& item) {
  item.de00_p95 = de00_p95;
  if (!stopped || item.decision != Decision::kDrawn) return;
  item.decision = Decision::kFirstPass;
  item.reason += "; the first pass shows what little it changes";
}

}  // namespace

void add_findings(const CorrectionNoise& rays, const FoundMaps& maps, Plan& plan) {
  if (PlanItem* item = row_of(plan, kSumsName); item != nullptr && maps.sums_de00_p95)
    add_finding(*maps.sums_de00_p95, maps.sums_stopped, *item);
  if (!plan.effects.rays.any()) return;
  for (std::size_t i = 0; i < ray_effect_names().size(); ++i) {
    PlanItem* item = row_of(plan, ray_effect_names()[i]);
    if (item == nullptr || !item->on) continue;
    if (rays.dark && !plan.effects.rays.floor) {
      item->needed = item->on = false, item->decision = Decision::kNotInScene;
      item->reason = "no ray meets the mesh", item->de00_p95 = 0;
      continue;
    }
    add_finding(rays.found[i].de00_p95, rays.found[i].stopped, *item);
  }
}

}  // namespace goniochrome::render
