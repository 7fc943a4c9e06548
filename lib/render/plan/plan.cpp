#include "render/plan/plan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "base/clock.h"
#include "base/parallel.h"
#include "base/text.h"
#include "render/exact.h"
#include "render/integral/integral_engine.h"
#include "render/internal/product_forms.h"
#include "render/internal/seen.h"
#include "render/plan/cost.h"
#include "render/plan/effect_list.h"
#include "render/textures/surface_layer.h"

namespace goniochrome::render {

namespace {

// The probe sees 95 % of some hundred points; the picture's own percentile is that far off at most times.
constexpr double kSafety = 0.8;

struct Words {
  std::string base = "auto";
  std::vector<std::pair<std::string, bool>> forced;  // name, on
};

Result<Words> words_of(const std::string& text) {
  Words words;
  for (const std::string_view piece : split(text, ',')) {
    const std::string word(trimmed(piece));
    if (word == "auto" || word == "all" || word == "none") {
      words.base = word;
    } else if (word.size() > 1 && (word[0] == '+' || word[0] == '-')) {
      words.forced.emplace_back(word.substr(1), word[0] == '+');
    } else {
      return usage_error("--effects is \"{}\": write auto, all or none, then +NAME or -NAME, as in \"auto,-fresnel\"",
                         text);
    }
  }
  for (const auto& [name, on] : words.forced) {
    const auto& groups = effect_groups();
    const bool lobe = name.starts_with("lobe-") || name.starts_with("gloss-") || name.starts_with("texture-");
    if (lobe && parse_number(name.substr(name.find('-') + 1))) continue;
    if (std::find(groups.begin(), groups.end(), name) != groups.end()) continue;
    std::string known;
    for (const std::string& group : groups) known += (known.empty() ? "" : ", ") + group;
    return usage_error("--effects names \"{}\": there are {}, and single lobes such as lobe-20 or gloss-900", name,
                       known);
  }
  return words;
}

// Shades the probe with any choice of effects.
class Prober {
 public:
  Prober(const Scene& scene, const Effects& all, const std::vector<EffectSwitch>& switches,
         const std::vector<VisiblePoint>& points, const std::vector<VisiblePoint>& seen, double white,
         CpuEngine& engine, CpuEngine& component_wise)
      : scene_(scene),
        all_(all),
        switches_(switches),
        points_(points),
        seen_(seen),
        white_(white > 0 ? white : 1),
        engine_(engine),
        component_wise_(component_wise) {}

  Effects effects(const std::vector<bool>& on) const {
    Effects effects = all_;
    for (std::size_t i = 0; i < switches_.size(); ++i) {
      if (!on[i]) switches_[i].turn_off(effects);
    }
    return effects;
  }

  std::vector<color::Rgb> colors(const std::vector<bool>& on) {
    const Effects chosen = effects(on);
    CpuEngine& engine = chosen.reflection ? engine_ : component_wise_;
    engine.load_paints(scene_, chosen, weight_table(scene_, chosen));
    std::vector<color::Rgb> colors = engine.shade(points_);
    if (scene_.layer != nullptr) scene_.layer->add(seen_, chosen, colors);
    return colors;
  }

  double difference(const std::vector<color::Rgb>& a, const std::vector<color::Rgb>& b) const {
    std::vector<double> de00;
    for (std::size_t i = 0; i < a.size(); ++i) de00.push_back(seen_difference(a[i], b[i], white_));
    return percentile_95(std::move(de00));
  }

  // What decides whether a change is seen: the difference that 95 % of the points stay below or, where few points hold
  // all of it, as they do a highlight, the root mean square.
  double seen(const std::vector<color::Rgb>& a, const std::vector<color::Rgb>& b) const {
    double squares = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      const double de00 = seen_difference(a[i], b[i], white_);
      squares += de00 * de00;
    }
    return std::max(difference(a, b), std::sqrt(squares / static_cast<double>(std::max<std::size_t>(a.size(), 1))));
  }

  // Seconds that a point takes on all cores together, the best of a few runs, each long enough that starting the
  // threads does not count.
  double seconds_per_point() const {
    if (points_.empty()) return 0;
    constexpr double kLong_s = 2e-4, kSlow_s = 2e-3, kEnough_s = 2e-2;
    std::vector<VisiblePoint> many = points_;
    const Stopwatch clock_once;
    const auto first = engine_.shade(points_);
    const double once_s = clock_once.elapsed_s();
    if (once_s > kSlow_s) {  // again nevertheless: the machine may have been busy
      double least_s = once_s, all_s = once_s;
      for (int i = 0; i < 2 && (i == 0 || all_s < kEnough_s); ++i) {
        const Stopwatch clock;
        const auto again = engine_.shade(points_);
        least_s = std::min(least_s, clock.elapsed_s()), all_s += clock.elapsed_s();
      }
      return least_s / static_cast<double>(points_.size());
    }
    for (double s = once_s; s < kLong_s && many.size() < 8192; s += once_s)
      many.insert(many.end(), points_.begin(), points_.end());
    double best = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) {
      const Stopwatch clock;
      const auto colors = engine_.shade(many);
      best = std::min(best, clock.elapsed_s());
    }
    return best / static_cast<double>(many.size());
  }

 private:
  const Scene& scene_;
  const Effects& all_;
  const std::vector<EffectSwitch>& switches_;
  const std::vector<VisiblePoint>& points_;
  const std::vector<VisiblePoint>& seen_;  // the same, with the parts of the whole scene
  double white_;
  CpuEngine &engine_, &component_wise_;
};

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
  std::erase_if(effects.lobes, [](const Effects::LobeUse& use) { return !use.directional_diffuse && !use.gloss; });
  const bool gloss = effects.mirror ||
                     std::any_of(effects.lobes.begin(), effects.lobes.end(), [](const auto& use) { return use.gloss; });
  effects.fresnel = effects.fresnel && gloss;
  effects.horizon = effects.horizon && !effects.lobes.empty();
  effects.anisotropy = effects.anisotropy && !effects.lobes.empty();
}

// What one frame's shading takes, in ms.
struct CostModel {
  const Scene& scene;
  PointCounts counts;
  double points = 0, pixels = 0, speed = 1;  // speed: measured over counted
  double textured = 0, mapped = 0;           // of the points
  int texture_lobes = 0;

  CostModel(const Scene& of, const Effects& all, const std::vector<VisiblePoint>& probe, double visible_pixels,
            const PlanRequest& request)
      : scene(of), points(visible_pixels * request.samples), pixels(request.pixels * request.samples) {
    counts = {mean_tilts(of, all, probe), all.reflection ? product_forms(of.reflection).count : 3};
    textured = points * share_of(scene, probe, [](const PartSurface& s) { return s.texture != nullptr; });
    mapped = points * share_of(scene, probe, [](const PartSurface& s) { return s.color_map != nullptr; });
    texture_lobes = scene.layer != nullptr ? scene.layer->lobes() : 0;
  }
  double ms(Effects effects, Engine engine) const {
    tidy(effects);
    const double texture_ns = textured > 0 ? textured_point_ns(effects, texture_lobes) : 0;
    const double ns = pixels * pixel_ns(engine) + points * point_ns(scene, effects, engine, counts) +
                      textured * texture_ns + mapped * mapped_point_ns(effects);
    return 1e-6 * speed * ns / threads();
  }
};

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

Choice forced_choice(const Words& words, const std::vector<EffectSwitch>& switches) {
  Choice choice{std::vector<bool>(switches.size()), std::vector<bool>(switches.size(), false)};
  for (std::size_t i = 0; i < switches.size(); ++i) {
    choice.on[i] = switches[i].needed && words.base != "none";
    for (const auto& [name, on] : words.forced) {
      if (name != switches[i].name && name != switches[i].group) continue;
      choice.on[i] = switches[i].needed && on;
      choice.forced[i] = true;
    }
  }
  return choice;
}

// Leaves out, cheapest to miss first, what all together cannot be seen. The gloss of a lamp stays: its highlight may
// lie between the points, and is the first thing that is seen.
void drop_unseen(Prober& prober, const std::vector<PlanItem>& items, bool lamps, double tolerance, Choice& choice) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (lamps && (items[i].effect.starts_with("gloss-") || items[i].effect.starts_with("texture-"))) continue;
    if (choice.on[i] && !choice.forced[i] && items[i].de00_p95 <= tolerance) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return items[a].de00_p95 < items[b].de00_p95; });
  const std::vector<color::Rgb> wanted = prober.colors(choice.on);
  for (const std::size_t i : order) {
    choice.on[i] = false;
    if (prober.seen(wanted, prober.colors(choice.on)) > kSafety * tolerance) choice.on[i] = true;
  }
}

// What leaving an effect out must save, of the frame's shading; less is lost in the noise of any measurement.
constexpr double kFree = 0.02;

// Takes back what was left out for nothing, whatever is worth most first: what is drawn with the rest at no price.
void take_back_free(const Prober& prober, const CostModel& cost, Engine engine, std::vector<PlanItem>& items,
                    Choice& choice) {
  std::vector<std::size_t> gone;
  for (std::size_t i = 0; i < items.size(); ++i)
    if (items[i].needed && !choice.on[i] && !choice.forced[i]) gone.push_back(i);
  std::ranges::stable_sort(gone, [&](std::size_t a, std::size_t b) { return items[a].de00_p95 > items[b].de00_p95; });
  for (const std::size_t i : gone) {
    const double without_ms = cost.ms(prober.effects(choice.on), engine);
    choice.on[i] = true;
    const double with_ms = cost.ms(prober.effects(choice.on), engine);
    if (with_ms - without_ms <= kFree * without_ms) {
      items[i].reason += "; costs nothing";
    } else {
      choice.on[i] = false;
    }
  }
}

// Leaves out what is worth least for its time until the rest fits, and takes back what fits after all; returns those
// left out.
std::set<std::size_t> keep_affordable(Prober& prober, const CostModel& cost, Engine engine, double budget_ms,
                                      Choice& choice) {
  std::set<std::size_t> gone;
  const std::vector<color::Rgb> wanted = prober.colors(choice.on);
  while (cost.ms(prober.effects(choice.on), engine) > budget_ms) {
    const double now_ms = cost.ms(prober.effects(choice.on), engine);
    std::size_t worst = choice.on.size();
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < choice.on.size(); ++i) {
      if (!choice.on[i] || choice.forced[i]) continue;
      choice.on[i] = false;
      const double saved_ms = now_ms - cost.ms(prober.effects(choice.on), engine);
      const double lost = prober.difference(wanted, prober.colors(choice.on)) / std::max(saved_ms, 1e-9);
      choice.on[i] = true;
      if (lost < least) least = lost, worst = i;
    }
    if (worst == choice.on.size()) break;
    choice.on[worst] = false;
    gone.insert(worst);
  }
  std::erase_if(gone, [&](std::size_t i) {
    choice.on[i] = true;
    const bool fits = cost.ms(prober.effects(choice.on), engine) <= budget_ms;
    choice.on[i] = fits;
    return fits;
  });
  return gone;
}

// Points that the integral is timed at.
constexpr std::size_t kTimed = 256;

void choose_engine(const PlanRequest& request, Plan& plan) {
  if (request.engine == Engine::kIntegral) {
    plan.engine = Engine::kIntegral;
    plan.engine_reason = fmt::format("as asked: predicted {:.0f} ms a frame; prefiltered maps would take {:.1f} ms",
                                     plan.integral_ms, std::min(plan.cpu_ms, plan.gl_ms));
    return;
  }
  const double cpu = plan.cpu_ms * request.frames, gl = plan.gl_ms * request.frames + kCompileMs;
  plan.engine = request.engine.value_or(cpu <= gl ? Engine::kCpu : Engine::kGl);
  plan.engine_reason =
      fmt::format("{}: predicted {:.1f} ms a frame on the processor, {:.1f} ms in OpenGL and {:.0f} ms to compile",
                  request.engine ? "as asked" : "the faster", plan.cpu_ms, plan.gl_ms, kCompileMs);
}

// At most `count` of the points, evenly spread.
std::vector<VisiblePoint> thinned(const std::vector<VisiblePoint>& points, std::size_t count) {
  std::vector<VisiblePoint> few;
  const std::size_t step = std::max<std::size_t>(1, points.size() / count);
  for (std::size_t i = 0; i < points.size(); i += step) few.push_back(points[i]);
  return few;
}

std::string decision_of(const EffectSwitch& effect, bool on, bool forced, bool over_budget) {
  if (!effect.needed) return "not in the scene";
  if (forced) return on ? "forced on" : "forced off";
  if (over_budget) return "over budget";
  return on ? "drawn" : "dropped";
}

}  // namespace

Result<void> check_effects(const std::string& effects) {
  GONIO_ASSIGN(const Words words, words_of(effects));
  return {};
}

std::vector<VisiblePoint> probe_points(const std::vector<std::shared_ptr<const Gbuffer>>& gbuffers, std::size_t count) {
  std::size_t visible = 0;
  for (const auto& g : gbuffers) {
    for (std::size_t i = 3; i < g->data.size(); i += 4) visible += g->data[i] != 0 ? 1 : 0;
  }
  // Every n-th visible point, row by row; a stride that shares no factor with common widths keeps columns apart.
  const std::size_t stride = std::max<std::size_t>(1, visible / count) | 1;
  std::vector<VisiblePoint> points;
  std::size_t met = stride / 2;
  for (const auto& g : gbuffers) {
    for (std::size_t i = 0; 4 * i + 3 < g->data.size(); ++i) {
      if (g->data[4 * i + 3] == 0 || ++met % stride != 0) continue;
      const int x = static_cast<int>(i) % g->width, y = static_cast<int>(i) / g->width;
      points.push_back({g->normal(x, y), g->to_viewer(x, y), g->part(x, y)});
    }
  }
  return points;
}

Scene seen_scene(const Scene& scene, const std::vector<std::shared_ptr<const Gbuffer>>& gbuffers) {
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

Result<Plan> make_plan(const Scene& scene, const std::vector<VisiblePoint>& probe, double visible_pixels,
                       const PlanRequest& request, CpuEngine& engine, CpuEngine& component_wise) {
  const Stopwatch clock;
  GONIO_ASSIGN(const Words words, words_of(request.effects));
  const Effects all = effects_of(scene);
  const std::vector<EffectSwitch> switches = effect_switches(scene, all, probe);
  const Compact compact = compacted(scene, probe);
  Prober prober(compact.scene, all, switches, compact.points, probe, request.white_luminance, engine, component_wise);
  const std::vector<bool> everything(switches.size(), true);
  const std::vector<color::Rgb> full = prober.colors(everything);

  CostModel cost(scene, all, probe, visible_pixels, request);
  const double counted_s = 1e-9 * point_ns(scene, all, Engine::kCpu, cost.counts) / threads();
  if (!probe.empty()) cost.speed = prober.seconds_per_point() / counted_s;
  Plan plan;
  for (std::size_t i = 0; i < switches.size(); ++i) {
    PlanItem item{switches[i].name, switches[i].needed, switches[i].reason, 0, 0, false, "", {}};
    if (item.needed) {
      std::vector<bool> without = everything;
      without[i] = false;
      item.de00_p95 = prober.difference(full, prober.colors(without));
    }
    plan.items.push_back(std::move(item));
  }
  Choice choice = forced_choice(words, switches);
  const bool summed = request.engine == Engine::kIntegral;
  if (words.base == "auto" && !summed)
    drop_unseen(prober, plan.items, !scene.lights.empty(), request.tolerance_de00, choice);
  plan.cpu_ms = cost.ms(prober.effects(choice.on), Engine::kCpu);
  plan.gl_ms = cost.ms(prober.effects(choice.on), Engine::kGl);
  if (summed) {
    const std::vector<VisiblePoint> timed = thinned(probe, kTimed);
    Effects effects = prober.effects(choice.on);
    effects.spread = spread_for(request.tolerance_de00);
    plan.integral_ms = 1000 * integral_seconds_per_point(timed, scene, effects) * cost.points;
  }
  choose_engine(request, plan);
  if (words.base == "auto" && !summed) take_back_free(prober, cost, plan.engine, plan.items, choice);
  std::set<std::size_t> gone;
  if (request.budget_ms > 0 && !summed) gone = keep_affordable(prober, cost, plan.engine, request.budget_ms, choice);
  plan.de00_p95 = prober.difference(full, prober.colors(choice.on));
  plan.effects = prober.effects(choice.on);
  plan.effects.spread = spread_for(request.tolerance_de00);
  plan.cpu_ms = cost.ms(plan.effects, Engine::kCpu), plan.gl_ms = cost.ms(plan.effects, Engine::kGl);
  for (std::size_t i = 0; i < switches.size(); ++i) {
    PlanItem& item = plan.items[i];
    std::vector<bool> without = everything;
    without[i] = false;
    if (item.needed)
      item.cost_ms = summed ? std::numeric_limits<double>::quiet_NaN()
                            : cost.ms(all, plan.engine) - cost.ms(prober.effects(without), plan.engine);
    item.on = choice.on[i];
    item.decision = decision_of(switches[i], item.on, choice.forced[i], gone.contains(i));
  }
  tidy(plan.effects);
  plan.time_ms = 1000 * clock.elapsed_s();
  return plan;
}

void add_truth(Plan& plan, const Scene& scene, const std::vector<VisiblePoint>& points, const envmap::Environment* env,
               double white_luminance) {
  const Effects all = effects_of(scene);
  const std::vector<EffectSwitch> switches = effect_switches(scene, all, points);
  const std::vector<color::Rgb> full = exact_radiance(points, scene, all, env);
  const double white = white_luminance > 0 ? white_luminance : 1;
  for (std::size_t i = 0; i < switches.size(); ++i) {
    if (!switches[i].needed) continue;
    Effects without = all;
    switches[i].turn_off(without);
    const std::vector<color::Rgb> colors = exact_radiance(points, scene, without, env);
    std::vector<double> de00;
    for (std::size_t j = 0; j < full.size(); ++j) de00.push_back(seen_difference(full[j], colors[j], white));
    plan.items[i].truth_de00_p95 = percentile_95(std::move(de00));
  }
}

}  // namespace goniochrome::render
