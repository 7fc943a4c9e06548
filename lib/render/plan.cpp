#include "render/plan.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <set>

#include "base/clock.h"
#include "base/parallel.h"
#include "base/text.h"
#include "render/cpu/cpu_engine.h"
#include "render/exact.h"
#include "render/internal/product_forms.h"
#include "render/internal/seen.h"
#include "render/internal/tilt_table.h"
#include "render/panes.h"
#include "render/plan/effect_list.h"
#include "render/plan/effect_words.h"
#include "render/plan/highlights.h"
#include "render/plan/kept.h"
#include "render/plan/prober.h"
#include "render/plan/ray_plan.h"
#include "render/plan/sum_choice.h"
#include "render/surface_layer.h"

namespace goniochrome::render {

namespace {

// The probe sees 95 % of some hundred points; the picture's own percentile is that far off at most times.
constexpr double kSafety = 0.8;

// Visible points that a plan is made from.
constexpr std::size_t kProbe = 512;

double mean_tilts(const Scene& scene, const Effects& effects, const std::vector<VisiblePoint>& points) {
  if (!effects.anisotropy || points.empty()) return 1;
  const auto tilts = tilts_of(scene, effects);
  double sum = 0;
  for (const VisiblePoint& point : points)
    sum += static_cast<double>(tilts[static_cast<std::size_t>(point.part)].size());
  return sum / static_cast<double>(points.size());
}

// The share of these points on parts with such a surface.
template <class Has>
double share_of(const Scene& scene, const std::vector<VisiblePoint>& points, Has has) {
  if (scene.layer == nullptr || points.empty()) return 0;
  const auto count = std::ranges::count_if(points, [&](const auto& p) { return has(scene.layer->surface(p.part)); });
  return static_cast<double>(count) / static_cast<double>(points.size());
}

// Lobes without any weight are not drawn, nor their maps uploaded.
void tidy(Effects& effects) {
  leave_out_idle(effects);
  std::erase_if(effects.lobes, [](const Effects::LobeUse& use) { return !use.directional_diffuse && !use.gloss; });
}

// What one frame of such pictures consists of.
Workload workload_of(const Scene& scene, const Effects& all, const std::vector<VisiblePoint>& probe,
                     const std::vector<std::shared_ptr<const Gbuffer>>& gbuffers, const PlanRequest& request) {
  double visible = 0, pixels = 0;
  for (const auto& g : gbuffers) {
    for (std::size_t i = 3; i < g->data.size(); i += 4) visible += g->data[i] != 0 ? 1 : 0;
    pixels += static_cast<double>(g->data.size() / 4);
  }
  // The G-buffers may be smaller than the frame.
  const double of_frame =
      request.pixels > 0 ? request.pixels : pixels / static_cast<double>(std::max<std::size_t>(1, gbuffers.size()));
  Workload work;
  work.scene = &scene, work.probe = &probe;
  work.pixels = of_frame * request.samples;
  work.points = (pixels > 0 ? of_frame * visible / pixels : 0) * request.samples;
  work.textured = work.points * share_of(scene, probe, [](const PartSurface& s) { return s.texture != nullptr; });
  if (scene.layer != nullptr && scene.layer->mapped())
    work.mapped = work.points * share_of(scene, probe, [](const PartSurface& s) { return s.color_map != nullptr; });
  work.tilts = mean_tilts(scene, all, probe), work.stretched = mean_stretch_lookups(scene, all, probe);
  for (int level = 1; level <= all.tilt_level; ++level) work.lookups.push_back(mean_lookups(scene, level, probe));
  work.forms = all.reflection ? product_forms(scene.reflection).count : 3;
  work.texture_lobes = scene.layer != nullptr ? scene.layer->lobes() : 0;
  if (scene.layer != nullptr) work.texture_filter = scene.layer->filter_cost(probe);
  return work;
}

// The shading of one frame with these effects.
double shading_ms(const Engine& engine, const Workload& work, Effects effects) {
  tidy(effects);
  leave_to_tilts(*work.scene, effects);
  return engine.price(work, effects).frame_ms;
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
    const auto same =
        std::find_if(first.begin(), first.end(), [&](std::size_t f) { return same_wear(scene, f, part); });
    place[part] = static_cast<int>(same - first.begin());
    if (same != first.end()) continue;
    first.push_back(part);
    compact.scene.paints.push_back(scene.paints[part]);
    compact.scene.gloss_deg.push_back(part < scene.gloss_deg.size() ? scene.gloss_deg[part] : 45);
    compact.scene.anisotropy.push_back(part < scene.anisotropy.size() ? scene.anisotropy[part] : paint::Anisotropy{});
  }
  for (VisiblePoint& point : compact.points) point.part = place[static_cast<std::size_t>(point.part)];
  return compact;
}

// What is on while the plan is made, and which of it may be changed.
struct Choice {
  std::vector<bool> on, forced;
};

// An effect that needs another one is off without it.
void settle(const std::vector<EffectSwitch>& switches, std::vector<bool>& on) {
  for (std::size_t i = 0; i < switches.size(); ++i)
    if (switches[i].needs >= 0 && !on[static_cast<std::size_t>(switches[i].needs)]) on[i] = false;
}

Choice forced_choice(const Words& words, const std::vector<EffectSwitch>& switches) {
  Choice choice{std::vector<bool>(switches.size()), std::vector<bool>(switches.size(), false)};
  for (std::size_t i = 0; i < switches.size(); ++i) {
    choice.on[i] = switches[i].needed && words.start != Start::kNone;
    for (const auto& [name, on] : words.forced) {
      if (name != switches[i].name && name != switches[i].group) continue;
      choice.on[i] = switches[i].needed && on;
      choice.forced[i] = true;
    }
  }
  for (std::size_t i = switches.size();
       i-- > 0;) {  // what a forced effect needs is on as well, unless it is forced off
    if (switches[i].needs < 0 || !choice.forced[i] || !choice.on[i]) continue;
    const auto needed = static_cast<std::size_t>(switches[i].needs);
    if (!choice.forced[needed]) choice.on[needed] = choice.forced[needed] = true;
  }
  settle(switches, choice.on);
  return choice;
}

// Whether tilted lobes are drawn.
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
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return items[a].de00_p95 < items[b].de00_p95; });
  // The finest set of tilted lobes comes first: what stands for it is then judged with the rest.
  const auto is_tilts = [&](std::size_t i) { return switches[i].group == "tilts"; };
  const auto rest = std::stable_partition(order.begin(), order.end(), is_tilts);
  std::sort(order.begin(), rest, std::greater<>());
  const std::vector<color::Rgb> wanted = prober.colors(choice.on);
  for (const std::size_t i : order) {
    const std::vector<bool> before = choice.on;
    choice.on[i] = false;
    settle(switches, choice.on);
    const std::vector<color::Rgb> colors = prober.colors(choice.on);
    if (prober.difference(wanted, colors) > kSafety * tolerance || prober.most(wanted, colors) > tolerance)
      choice.on = before;
  }
}

// What leaving an effect out must save, of the frame's shading; less is lost in the noise of any measurement.
constexpr double kFree = 0.02;

// Takes back what was left out for nothing, whatever is worth most first: what is drawn with the rest at no price.
void take_back_free(const Prober& prober, const Workload& work, const Engine& engine,
                    const std::vector<EffectSwitch>& switches, std::vector<PlanItem>& items, Choice& choice) {
  std::vector<std::size_t> gone;
  for (std::size_t i = 0; i < items.size(); ++i)
    if (items[i].needed && !choice.on[i] && !choice.forced[i]) gone.push_back(i);
  std::ranges::stable_sort(gone, [&](std::size_t a, std::size_t b) { return items[a].de00_p95 > items[b].de00_p95; });
  for (const std::size_t i : gone) {
    if (switches[i].needs >= 0 && !choice.on[static_cast<std::size_t>(switches[i].needs)]) continue;
    const double without_ms = shading_ms(engine, work, prober.effects(choice.on));
    choice.on[i] = true;
    const double with_ms = shading_ms(engine, work, prober.effects(choice.on));
    if (with_ms - without_ms <= kFree * without_ms) {
      items[i].reason += "; costs nothing";
    } else {
      choice.on[i] = false;
    }
  }
}

// Leaves out what is worth least for its time until the rest fits, and takes back what fits after all; returns those
// left out.
std::set<std::size_t> keep_affordable(Prober& prober, const Workload& work, const Engine& engine,
                                      const std::vector<EffectSwitch>& switches, double budget_ms, Choice& choice) {
  const auto now = [&] { return shading_ms(engine, work, prober.effects(choice.on)); };
  std::set<std::size_t> gone;
  const std::vector<color::Rgb> wanted = prober.colors(choice.on);
  for (double now_ms = now(); now_ms > budget_ms; now_ms = now()) {
    std::size_t worst = choice.on.size();
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < choice.on.size(); ++i) {
      if (!choice.on[i] || choice.forced[i]) continue;
      if (switches[i].left_to_tilts && tilted(switches, choice.on)) continue;
      const std::vector<bool> before = choice.on;
      choice.on[i] = false;
      settle(switches, choice.on);
      const double saved_ms = now_ms - now();
      const double lost = prober.difference(wanted, prober.colors(choice.on)) / std::max(saved_ms, 1e-9);
      choice.on = before;
      if (lost < least) least = lost, worst = i;
    }
    if (worst == choice.on.size()) break;
    const std::vector<bool> before = choice.on;
    choice.on[worst] = false;
    settle(switches, choice.on);
    for (std::size_t i = 0; i < before.size(); ++i)
      if (before[i] && !choice.on[i]) gone.insert(i);
  }
  std::erase_if(gone, [&](std::size_t i) {
    if (switches[i].needs >= 0 && !choice.on[static_cast<std::size_t>(switches[i].needs)]) return false;
    choice.on[i] = true;
    const bool fits = now() <= budget_ms;
    choice.on[i] = fits;
    return fits;
  });
  return gone;
}

// An engine and what it is predicted to take.
struct Priced {
  const Engine* engine = nullptr;
  Price price;
  double total_ms(int frames) const { return price.frame_ms * frames + price.once_ms; }
};

// Those that plans may choose; or the single one that was asked for and that plans may not choose, last.
std::vector<Priced> priced(const std::vector<const Engine*>& engines, const Engine* wanted, const Workload& work,
                           Effects effects) {
  tidy(effects);
  leave_to_tilts(*work.scene, effects);
  std::vector<Priced> result;
  for (const Engine* engine : engines) {
    if (engine->info().is_planned) result.push_back({engine, engine->price(work, effects)});
  }
  if (wanted != nullptr && !wanted->info().is_planned) result.push_back({wanted, wanted->price(work, effects)});
  return result;
}

// The engine that was asked for or, of those that plans may choose, the fastest over all frames.
const Priced& chosen_of(const std::vector<Priced>& all, const Engine* wanted, int frames) {
  if (wanted != nullptr) return *std::ranges::find(all, wanted, &Priced::engine);
  return *std::ranges::min_element(all, {}, [&](const Priced& p) { return p.total_ms(frames); });
}

std::string reason_of(const std::vector<Priced>& all, const Priced& chosen, bool asked) {
  std::string planned;
  double least_ms = std::numeric_limits<double>::infinity();
  std::size_t count = 0;
  for (const auto& [engine, price] : all) {
    if (!engine->info().is_planned) continue;
    planned += fmt::format("{}{:.1f} ms{} {}", count == 0 ? "" : ", ", price.frame_ms, count == 0 ? " a frame" : "",
                           engine->info().where);
    if (price.once_ms > 0) planned += fmt::format(" and {:.0f} ms {}", price.once_ms, price.once);
    least_ms = std::min(least_ms, price.frame_ms), ++count;
  }
  if (!chosen.engine->info().is_planned)
    return fmt::format("as asked: predicted {:.0f} ms a frame; prefiltered maps would take {:.1f} ms",
                       chosen.price.frame_ms, least_ms);
  return fmt::format("{}: predicted {}", asked ? "as asked" : count > 1 ? "the faster" : "the only one here", planned);
}

// The plan for an engine that draws everything and does without prefiltered maps: there is nothing to choose, and
// nothing to try it out by.
Plan plan_of_everything(const Scene& scene, const Effects& all, const std::vector<VisiblePoint>& probe,
                        const EngineInfo& engine) {
  Plan plan;
  for (const EffectSwitch& effect : effect_switches(scene, all, probe)) {
    PlanItem item;
    item.effect = effect.name, item.needed = effect.needed, item.reason = effect.reason;
    item.de00_p95 = item.cost_ms = std::numeric_limits<double>::quiet_NaN();
    item.on = effect.needed;
    item.decision = effect.needed ? Decision::kDrawn : Decision::kNotInScene;
    plan.items.push_back(std::move(item));
  }
  for (const std::string& name : ray_effect_names()) {
    PlanItem item;
    const bool there = name != "floor" || scene.ground.has_value();
    item.effect = name, item.needed = item.on = there;
    item.reason = there ? "drawn by every path" : "no floor is asked for";
    item.de00_p95 = item.cost_ms = std::numeric_limits<double>::quiet_NaN();
    item.decision = there ? Decision::kDrawn : Decision::kNotInScene;
    plan.items.push_back(std::move(item));
  }
  plan.effects = all;
  plan.engine = engine.name;
  plan.engine_reason = "as asked: it draws every effect by rays alone, without prefiltered maps";
  return plan;
}

// Where prefiltered maps do not keep the tolerance and rays alone are faster, everything is drawn by these.
void take_rays_alone(const Effects& all, const RayChoice& by_rays, double tolerance_de00, double most_in_all,
                     const Engine& tracer, Plan& plan) {
  const double by_maps_ms = plan.predicted_ms() + plan.sums_ms + plan.rays_ms;
  for (PlanItem& item : plan.items) {
    if (!item.needed) continue;
    item.on = true, item.decision = Decision::kDrawn;
  }
  plan.engine_reason = fmt::format(
      "prefiltered maps would miss the truth by dE00 {:.2g} (p95) in {:.0f} ms; rays alone keep the tolerance in "
      "{:.0f}",
      *plan.whole_de00_p95, by_maps_ms, by_rays.path_ms);
  plan.engine = tracer.info().name;
  plan.prices.push_back({plan.engine, by_rays.path_ms, 0});
  plan.effects = all;
  plan.effects.most_samples_in_all = most_in_all;
  plan.de00_p95 = plan.sums_ms = plan.rays_ms = plan.rays_noise_de00 = 0;
  plan.open_de00_p95 = plan.whole_de00_p95 = tolerance_de00;
  plan.not_kept.clear();
}

Decision decision_of(const EffectSwitch& effect, bool on, bool forced, bool over_budget) {
  if (!effect.needed) return Decision::kNotInScene;
  if (forced) return on ? Decision::kForcedOn : Decision::kForcedOff;
  if (over_budget) return Decision::kOverBudget;
  return on ? Decision::kDrawn : Decision::kDropped;
}

// The engine cpu with all effects of a scene, by which effects are tried out; and a second one for the plain product of
// colors, if the scene has another.
struct Probers {
  CpuEngine all, plain;
  CpuEngine& component_wise(const Effects& effects) { return effects.reflection ? plain : all; }
  Result<void> load(const Scene& scene, const Effects& effects) {
    GONIO_TRY(all.load(scene, effects));
    if (!effects.reflection) return {};
    Effects without = effects;
    without.reflection = false;
    return plain.load(scene, without);
  }
};

}  // namespace

double Plan::predicted_ms() const {
  const auto of = std::ranges::find(prices, engine, &EnginePrice::engine);
  return of == prices.end() ? 0 : of->frame_ms;
}

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
      pixels.push_back({g.get(), static_cast<int>(i) % g->width, static_cast<int>(i) / g->width});
    }
  }
  return pixels;
}

std::vector<VisiblePoint> probe_points(const std::vector<std::shared_ptr<const Gbuffer>>& gbuffers, std::size_t count,
                                       const mesh::Mesh* mesh) {
  std::vector<VisiblePoint> points;
  for (const auto& [g, x, y] : probe_pixels(gbuffers, count)) points.push_back(g->point(x, y, {}, mesh));
  return points;
}

namespace {

// With the footprints on textures that one of so many samples of a pixel has; see SurfaceLayer::put_places().
std::vector<VisiblePoint> probe_points(const std::vector<std::shared_ptr<const Gbuffer>>& gbuffers, std::size_t count,
                                       const Scene& scene, int samples) {
  std::vector<VisiblePoint> points = probe_points(gbuffers, count, scene.mesh);
  if (scene.layer == nullptr || !scene.layer->textured()) return points;
  std::size_t number = 0;
  for (const ProbePixel& pixel : probe_pixels(gbuffers, count)) {
    VisiblePoint& point = points[number++];
    scene.layer->put_places(*pixel.gbuffer, pixel.x, pixel.y, 1 / std::sqrt(samples), point);
  }
  return points;
}

}  // namespace

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
                       const PlanRequest& request, const std::vector<const Engine*>& engines, const RayContext& rays) {
  GONIO_ASSIGN(const Words words, words_of(request.effects));
  Effects all = effects_of(scene);
  all.tolerance_de00 = request.tolerance_de00;
  const std::vector<VisiblePoint> probe = probe_points(gbuffers, kProbe, scene, request.samples);
  const auto wanted = std::ranges::find_if(
      engines, [&](const Engine* engine) { return request.engine && *request.engine == engine->info().name; });
  const Engine* asked = wanted == engines.end() ? nullptr : *wanted;
  if (asked != nullptr && asked->info().traces_rays) return plan_of_everything(scene, all, probe, asked->info());
  Probers probers;
  GONIO_TRY(probers.load(scene, all));
  const Stopwatch clock;

  // What each effect is worth.
  const std::vector<EffectSwitch> switches = effect_switches(scene, all, probe);
  const PaneProbe panes = pane_probe(rays.whole, scene, probe_pixels(gbuffers, kProbe));
  std::vector<VisiblePoint> points = probe;
  points.insert(points.end(), panes.behind.begin(), panes.behind.end());
  const std::vector<VisiblePoint> highlights = highlight_points(scene, all, points);
  points.insert(points.begin() + static_cast<std::ptrdiff_t>(probe.size()), highlights.begin(), highlights.end());
  const Compact compact = compacted(scene, points);
  Prober prober(compact.scene, all, switches, compact.points, points, probe.size(), request.white_luminance,
                probers.all, probers.component_wise(all), &panes);
  const std::vector<bool> everything(switches.size(), true);
  const auto all_but = [&](std::size_t i) {
    std::vector<bool> without = everything;
    without[i] = false;
    return without;
  };
  const std::vector<color::Rgb> full = prober.colors(everything);
  Workload work = workload_of(scene, all, probe, gbuffers, request);
  if (!probe.empty()) {
    const double of_probe = work.points / static_cast<double>(probe.size());
    work.behind_points = of_probe * static_cast<double>(panes.behind.size());
    work.behind_pixels = work.behind_points + of_probe * static_cast<double>(panes.beyond.size());
  }
  if (!probe.empty())
    work.speed = prober.seconds_per_point() / (1e-9 * CpuEngine::counted_point_ns(work, all) / threads());
  Plan plan;
  for (std::size_t i = 0; i < switches.size(); ++i) {
    PlanItem item;
    item.effect = switches[i].name, item.needed = switches[i].needed, item.reason = switches[i].reason;
    if (item.needed) item.de00_p95 = prober.difference(full, prober.colors(all_but(i)));
    plan.items.push_back(std::move(item));
  }

  // What the mesh does to light comes first: what is left out of that, the others may not leave out as well.
  std::optional<OpenTruth> open_truth;
  if (scene.env != nullptr && rays.texels != nullptr && !probe.empty() &&
      (asked == nullptr || asked->info().is_planned))
    open_truth.emplace(scene, all, probe, *rays.texels, request.white_luminance);
  SumChoice sums = scene.env == nullptr ? no_sums("no image light") : unmeasured_sums(request);
  if (open_truth) {
    GONIO_ASSIGN(sums, sum_choice(*open_truth, prober.front_colors(everything), scene, all, gbuffers, request, words,
                                  *rays.residual));
  }
  for (std::size_t i = 0; i < switches.size(); ++i) {
    if (!switches[i].beyond_maps || !switches[i].needed) continue;
    Effects without = all;
    switches[i].turn_off(without);
    plan.items[i].de00_p95 =
        open_truth ? open_truth->difference(OpenTruth(scene, without, probe, *rays.texels, request.white_luminance))
                   : std::numeric_limits<double>::quiet_NaN();
  }
  const Stopwatch ray_clock;
  const RayChoice by_rays =
      planned_rays(scene, gbuffers, request, words, rays, work.points, sums.open_de00, [&](const auto& seen) {
        const Compact probed = compacted(scene, seen);
        return Prober(probed.scene, all, switches, probed.points, seen, seen.size(), request.white_luminance,
                      probers.all, probers.component_wise(all))
            .colors(everything);
      });
  plan.ray_pricing_ms = 1000 * ray_clock.elapsed_s();
  const double tolerance = std::max(0.0, request.tolerance_de00 - by_rays.left_out_de00_p95);

  // Which of them are drawn, and by which engine.
  Choice choice = forced_choice(words, switches);
  const bool may_leave_out = asked == nullptr || asked->info().is_planned;
  const bool automatic = words.start == Start::kAuto && may_leave_out;
  for (std::size_t i = 0; i < switches.size() && may_leave_out; ++i)
    if (switches[i].beyond_maps) choice.on[i] = false, choice.forced[i] = true;
  if (automatic) drop_unseen(prober, switches, plan.items, tolerance, choice);
  std::vector<Priced> prices = priced(engines, asked, work, prober.effects(choice.on));
  const Engine& engine = *chosen_of(prices, asked, request.frames).engine;
  plan.engine = engine.info().name;
  plan.engine_reason = reason_of(prices, chosen_of(prices, asked, request.frames), asked != nullptr);
  if (automatic) take_back_free(prober, work, engine, switches, plan.items, choice);
  std::set<std::size_t> gone;
  if (request.budget_ms > 0 && may_leave_out)
    gone = keep_affordable(prober, work, engine, switches, request.budget_ms, choice);

  // What that comes to.
  plan.de00_p95 = prober.difference(full, prober.colors(choice.on)) + by_rays.left_out_de00_p95;
  plan.effects = prober.effects(choice.on);
  tidy(plan.effects);
  leave_to_tilts(scene, plan.effects);
  plan.effects.rays = by_rays.effects;
  plan.effects.most_ray_samples = by_rays.most_samples, plan.effects.ray_noise_de00 = by_rays.aim_de00;
  plan.effects.most_samples_in_all = by_rays.most_in_all;
  plan.rays_ms = by_rays.cost.ms, plan.rays_noise_de00 = by_rays.noise_de00;
  const bool has_maps = scene.env != nullptr && !engine.info().needs_texels;
  if (sums.item.on) {
    plan.effects.sums = true, plan.sums_ms = sums.item.cost_ms;
    GONIO_TRY(rays.residual->load(scene, plan.effects));
  }
  if (open_truth) {
    const std::vector<color::Rgb> more =
        sums.item.on ? rays.residual->at(open_truth->points()) : std::vector<color::Rgb>();
    plan.open_de00_p95 = open_truth->error(prober.front_colors(choice.on), more).p95;
  }
  if (!has_maps)
    plan.open_de00_p95 = scene.env != nullptr ? request.tolerance_de00 : plan.de00_p95 - by_rays.left_out_de00_p95;
  if (rays.transport != nullptr && plan.open_de00_p95)
    plan.whole_de00_p95 = std::hypot(*plan.open_de00_p95, by_rays.left_out_de00_p95, by_rays.noise_de00);
  plan.not_kept = reason_not_kept(plan, by_rays, request, has_maps);
  for (const auto& [of, price] : prices) {
    const Price now = of->info().is_planned ? of->price(work, plan.effects) : price;
    plan.prices.push_back({of->info().name, now.frame_ms, now.once_ms});
  }
  for (std::size_t i = 0; i < switches.size(); ++i) {
    PlanItem& item = plan.items[i];
    if (item.needed)
      item.cost_ms = may_leave_out
                         ? shading_ms(engine, work, all) - shading_ms(engine, work, prober.effects(all_but(i)))
                         : std::numeric_limits<double>::quiet_NaN();
    item.on = choice.on[i];
    item.decision = decision_of(switches[i], item.on, choice.forced[i], gone.contains(i));
    if (switches[i].needed && switches[i].beyond_maps && may_leave_out) {
      item.decision = Decision::kDropped;
      item.reason += "; prefiltered maps cannot show it, the engines integral and path do";
    }
  }
  plan.items.push_back(sums.item);
  plan.items.insert(plan.items.end(), by_rays.items.begin(), by_rays.items.end());
  const auto tracer = std::ranges::find_if(engines, [](const Engine* of) { return of->info().traces_rays; });
  const bool may_take = asked == nullptr && words.start == Start::kAuto && words.forced.empty();
  plan.path_ms = by_rays.path_ms, plan.path_samples = by_rays.path_samples;
  const double most = request.most_ray_samples;  // 0: no limit
  if (may_take && tracer != engines.end() && !plan.not_kept.empty() && by_rays.path_ms > 0 &&
      by_rays.path_ms < plan.predicted_ms() + plan.sums_ms + plan.rays_ms && (most <= 0 || by_rays.path_in_all <= most))
    take_rays_alone(all, by_rays, request.tolerance_de00, request.most_ray_samples, **tracer, plan);
  plan.time_ms = 1000 * clock.elapsed_s();
  return plan;
}

void add_truth(Plan& plan, const Scene& scene, const std::vector<VisiblePoint>& points, const envmap::Environment* env,
               double white_luminance) {
  const Effects all = effects_of(scene);
  const std::vector<EffectSwitch> switches = effect_switches(scene, all, points);
  // Facets take the place of gloss lobes: what one of these is worth shows where lobes are drawn.
  Effects by_lobes = all;
  by_lobes.satin = false;
  const std::vector<color::Rgb> full = exact_radiance(points, scene, all, env),
                                lobes = all.satin ? exact_radiance(points, scene, by_lobes, env) : full;
  const double white = white_luminance > 0 ? white_luminance : 1;
  for (std::size_t i = 0; i < switches.size(); ++i) {
    if (!switches[i].needed || switches[i].refines) continue;  // the reference has no sets
    Effects without = by_lobes;
    switches[i].turn_off(without);
    const std::vector<color::Rgb>& with = switches[i].beyond_maps ? full : lobes;
    const std::vector<color::Rgb> colors = exact_radiance(points, scene, without, env);
    std::vector<double> de00;
    for (std::size_t j = 0; j < with.size(); ++j) de00.push_back(seen_difference(with[j], colors[j], white));
    plan.items[i].truth_de00_p95 = percentile_95(std::move(de00));
  }
}

}  // namespace goniochrome::render
