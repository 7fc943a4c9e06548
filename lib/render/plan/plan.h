// What a picture is shaded with, and what each effect is worth: decided before drawing, from a sample of the G-buffer.
// goniochrome-theory(7), PLAN.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "render/cpu/cpu_engine.h"
#include "render/effects.h"
#include "render/gbuffer.h"
#include "render/scene.h"

namespace goniochrome::envmap {
class Environment;
}

namespace goniochrome::render {

struct PlanRequest {
  double tolerance_de00 = 0.5;   // what leaving effects out may change, p95 over visible pixels, all together
  double budget_ms = 0;          // of one frame's shading; 0 is none
  std::string effects = "auto";  // auto, all or none, then +NAME and -NAME, separated by commas
  std::optional<Engine> engine;  // none: cpu or gl, the one predicted faster
  double white_luminance = 1;    // what color differences are relative to
  int samples = 1, frames = 1;
  double pixels = 0;  // of one frame, seen or not; 0: those of the G-buffers
};

struct PlanItem {
  std::string effect;
  bool needed = false;  // the scene calls for it
  std::string reason;
  double de00_p95 = 0;  // what leaving it out alone changes
  double cost_ms = 0;   // what it adds to a frame's shading; NaN of the integral, which sums all of them at once
  bool on = false;
  std::string decision;                  // drawn | dropped | forced on | forced off | over budget | not in the scene
  std::optional<double> truth_de00_p95;  // the same by the reference integrator
};

struct Plan {
  std::vector<PlanItem> items;
  Effects effects;
  Engine engine = Engine::kCpu;
  std::string engine_reason;
  double cpu_ms = 0, gl_ms = 0;  // predicted shading of a frame
  double integral_ms = 0;        // the same; 0 where that engine was not asked for
  double de00_p95 = 0;           // predicted for all that is left out together
  double time_ms = 0;            // that planning took

  // Of the engine that was chosen.
  double predicted_ms() const { return engine == Engine::kCpu ? cpu_ms : engine == Engine::kGl ? gl_ms : integral_ms; }
};

// Error (usage): a word of --effects that is none, with those there are.
Result<void> check_effects(const std::string& effects);

// Up to `count` visible points, evenly spread over those of all G-buffers.
std::vector<VisiblePoint> probe_points(const std::vector<std::shared_ptr<const Gbuffer>>& gbuffers, std::size_t count);

// The scene as far as it is seen: paints of parts that no G-buffer shows are bare, so that nothing is loaded for them.
Scene seen_scene(const Scene& scene, const std::vector<std::shared_ptr<const Gbuffer>>& gbuffers);

// `engine` must be loaded with all effects of the scene, `component_wise` with all but the operator (it may be the same
// where the scene has none); their weights are changed. `visible_pixels` of one frame.
Result<Plan> make_plan(const Scene& scene, const std::vector<VisiblePoint>& probe, double visible_pixels,
                       const PlanRequest& request, CpuEngine& engine, CpuEngine& component_wise);

// Fills in the truth of every effect that is needed: the change of the exact picture without it, at these points.
void add_truth(Plan& plan, const Scene& scene, const std::vector<VisiblePoint>& points, const envmap::Environment* env,
               double white_luminance);

}  // namespace goniochrome::render
