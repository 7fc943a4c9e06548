// A plan decides, before a picture is drawn, with which effects and by which engine it is shaded. An effect is drawn
// where the scene calls for it. What the lobes and look-ups of prefiltered maps show is tried out on some of the
// visible points, and what nobody sees there is left out. What rays and sums change is told by the first pass of the
// picture. goniochrome-theory(7), PLAN.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "render/effects.h"
#include "render/gbuffer.h"
#include "render/scene.h"

namespace goniochrome::envmap {
class Environment;
}

namespace goniochrome::render {

class CpuEngine;
class Engine;
struct CorrectionNoise;

// What rays can add to a picture.
struct RayContext {
  std::string absent = "no rays are traced";  // why none are traced; "" where they are
  bool refused = false;                       // whether that is because --effects says so
  bool floor = false;                         // whether there is a floor to draw
  bool floor_forced = false;                  // whether it is asked for by name
  std::string no_floor;                       // why there is none; "" where there is, or where nothing is said of it
  bool has_environment = false;               // whether the light is at hand of which sums are made
};

struct PlanRequest {
  double tolerance_de00 = 0.5;        // what leaving effects out may change, p95 over visible pixels, all together
  bool quick = false;                 // the noise of rays that nobody named may be the whole tolerance
  std::string effects = "auto";       // auto, all or none, then +NAME and -NAME, separated by commas
  std::optional<std::string> engine;  // by name; none: the first that draws by prefiltered maps
  double white_luminance = 1;         // what color differences are relative to
  int samples = 1;
};

// What became of an effect.
enum class Decision { kNotInScene, kDrawn, kDropped, kForcedOn, kForcedOff, kFirstPass };

// As plans, reports and the headers of pictures spell it. image::read_aov_file() reads it back.
const char* spelled(Decision decision);

struct PlanItem {
  std::string effect;
  bool needed = false;  // the scene calls for it
  std::string reason;
  // What leaving it out alone changes, at 95 of 100 points; NaN where it was not measured. Of rays and sums it is what
  // the first pass found.
  double de00_p95 = 0;
  bool on = false;
  Decision decision = Decision::kNotInScene;
  std::optional<double> truth_de00_p95;  // the same as de00_p95, by the reference integrator
};

struct Plan {
  std::vector<PlanItem> items;
  Effects effects;
  std::string engine;  // that was chosen
  std::string engine_reason;
  double de00_p95 = 0;  // of all that is left out of the maps together
  double time_ms = 0;   // that planning took, the maps loaded that the picture needs as well
};

// What the first pass finds that sums change at 95 of 100 points, and whether nobody sees it, so that they are left
// out; nothing without sums.
struct FoundSums {
  std::optional<double> de00_p95;
  bool stopped = false;
};

// Takes what the first pass of a picture found.
void add_findings(const CorrectionNoise& rays, const FoundSums& sums, Plan& plan);

// Error (usage): a word of --effects that names no effect, with the names that there are.
Result<void> check_effects(const std::string& effects);

// Whether such words leave no effect of rays on, so that no rays need be traced for them. The words are checked.
bool leave_out_rays(const std::string& effects);
// Whether they force the floor, or the sums, on or off; nothing where they do not name it.
std::optional<bool> floor_forced(const std::string& effects);
std::optional<bool> sums_forced(const std::string& effects);

// Up to `count` pixels of which each shows something, evenly spread over those of all G-buffers.
struct ProbePixel {
  const Gbuffer* gbuffer = nullptr;
  int x = 0, y = 0;
};
std::vector<ProbePixel> probe_pixels(const std::vector<std::shared_ptr<const Gbuffer>>& gbuffers, std::size_t count);
// The points that they show.
std::vector<VisiblePoint> probe_points(const std::vector<std::shared_ptr<const Gbuffer>>& gbuffers, std::size_t count,
                                       const mesh::Mesh* mesh = nullptr);

// The scene as far as it is seen: paints of parts that no G-buffer shows are bare, so that nothing is loaded for them.
// Behind panes anything may be seen.
Scene seen_scene(const Scene& scene, const std::vector<std::shared_ptr<const Gbuffer>>& gbuffers);

// Plans the drawing of `scene`, as seen_scene() has it, by one of these engines, of which there is at least one. The
// engine that is asked for must be among them. The effects are tried out by `tried`, whose maps may serve the picture.
// Error: as for loading it with all effects of the scene, and as check_effects(). Sums and the effects of rays come
// last in the plan.
Result<Plan> make_plan(const Scene& scene, const std::vector<std::shared_ptr<const Gbuffer>>& gbuffers,
                       const PlanRequest& request, const std::vector<const Engine*>& engines, const RayContext& rays,
                       CpuEngine& tried);

// Fills in the truth of every effect that is needed: the change of the exact picture without it, at these points.
void add_truth(Plan& plan, const Scene& scene, const std::vector<VisiblePoint>& points, const envmap::Environment* env,
               double white_luminance);

}  // namespace goniochrome::render
