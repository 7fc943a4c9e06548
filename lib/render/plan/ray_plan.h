// Which effects of rays a picture is drawn with. goniochrome-theory(7), PLAN, Effects of rays.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "render/plan.h"
#include "render/plan/effect_words.h"
#include "render/plan/floor_probe.h"
#include "render/plan/ray_probe.h"

namespace goniochrome::render {

// The part of the tolerance that the noise of these effects may take, as one standard deviation at 95 of 100 points.
// The error of a point may be several times its standard deviation, so that this alone does not keep the whole picture
// within the tolerance: --check-against truth tells.
constexpr double kRayNoiseShare = 0.5;

// The noise that is aimed at. Where nobody asked for the effects by name, it is also that part of what the maps err by:
// samples that lower it further would not bring the picture much nearer to the truth.
struct RayNoise {
  double asked_de00 = 0, unasked_de00 = 0;
};
RayNoise ray_noise(double tolerance_de00, double open_de00_p95);

// The names of the effects, in the order in which plans list them.
const std::vector<std::string>& ray_effect_names();

// What decides, beside what the effects are worth.
struct RayWishes {
  bool on = true;         // whether what is not forced is on to begin with
  bool automatic = true;  // whether it may be left out for being unseen
  std::function<std::optional<bool>(const std::string& name)> forced;
  double tolerance_de00 = 0.5;
  double open_de00_p95 = 0;  // what the engine misses of the open light
  double budget_ms = 0;      // of one frame's rays; 0: none
  double most_in_all = 0;    // samples of a picture; 0: no limit
  double visible_points = 0;
  int samples = 1;
  bool floor = false;                    // whether a floor is drawn, which needs `shadow`
  double floor_pixels = 0;               // that show the floor
  const FloorProbe* of_floor = nullptr;  // what these cost; null: nothing
};

// The most samples of a point that are drawn for effects that nobody asked for by name. Most points get far fewer.
constexpr int kMostUnaskedSamples = 1024;

struct RayChoice {
  std::vector<PlanItem> items;
  RayEffects effects;
  double left_out_de00_p95 = 0;  // of all that is left out and was not forced off
  RayCost cost;                  // of what is drawn
  int most_samples = 1 << 16;    // of a point
  double most_in_all = 0;        // of a picture; 0: no limit
  double aim_de00 = 0.25;        // noise that is aimed at
  double noise_de00 = 0;         // that is to be expected of what is drawn
  double named_ms = 0;           // of a frame with as many samples as it takes, as where the effects are named
  double path_ms = 0;            // of a frame by the engine path, within the tolerance; 0: not known
  double path_samples = 0;       // of a pixel then, the mean
  double path_in_all = 0;        // and of all pixels together
};

// Effects that need another one are off with it: `self` and `bounce` need `shadow`. Forcing one of them on forces
// `shadow` on, unless that is forced off.
RayChoice ray_choice(const RayProbe& probe, const RayWishes& wishes);

// Where rays cannot be traced, or may not: all effects off, for this reason.
RayChoice no_rays(const std::string& reason, bool refused = false);

// The effects of rays of a scene, as far as there are rays. `points_drawn`: of one picture, with all samples of its
// pixels. `open_de00`: as RayWishes has it. `colors` shades points with all other effects.
RayChoice planned_rays(const Scene& scene, const std::vector<std::shared_ptr<const Gbuffer>>& gbuffers,
                       const PlanRequest& request, const Words& words, const RayContext& rays, double points_drawn,
                       double open_de00,
                       const std::function<std::vector<color::Rgb>(const std::vector<VisiblePoint>&)>& colors);

}  // namespace goniochrome::render
