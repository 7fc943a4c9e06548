// A plan decides, before a picture is drawn, with which effects and by which engine it is shaded. It measures on a
// sample of the visible points what each effect is worth and what it costs, and leaves out what is not seen or not
// affordable. goniochrome-theory(7), PLAN.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "render/effects.h"
#include "render/gbuffer.h"
#include "render/scene.h"

namespace goniochrome::envmap {
class BlockTree;
class Environment;
}  // namespace goniochrome::envmap

namespace goniochrome::rays {
class RayScene;
}

namespace goniochrome::render {

class Engine;
class OpenResidual;
class Transport;

// What the effects of rays are priced by.
struct RayContext {
  const Transport* transport = nullptr;  // of the whole scene, not only what is seen of it; null: no rays
  // The same over the floor that the picture calls for; null: none.
  const Transport* over_floor = nullptr;
  bool floor_forced = false;                         // whether that is asked for by name
  const envmap::Environment* environment = nullptr;  // that rays meet
  // What the engine path would trace, floor and all, made when it is asked for; null: it cannot. Empty: that engine is
  // not priced.
  std::function<const Transport*()> alone;
  int bounces = 8;
  std::uint64_t seed = 1;
  std::string absent = "no rays are traced";  // why there is no transport
  bool refused = false;                       // whether that is because --effects says so
  std::string no_floor;                       // why no floor is priced; "" where one is, or where nothing is said of it
  const rays::RayScene* whole = nullptr;      // the mesh with its panes, of a scene that has any
  // Of the light that rays meet, to measure by how much maps miss the open light; null: that is not measured.
  const envmap::BlockTree* texels = nullptr;
  OpenResidual* residual = nullptr;  // by which that is corrected; there where texels are
};

// What a picture may cost for which nobody asked how accurate it is to be, nor how long it may take: so many samples of
// rays. A sample of a white teapot under a sun took 0.9 us of processor, built with -O1, so that two cores take
// some 7 s for them.
constexpr double kMostUnaskedInAll = 16e6;

struct PlanRequest {
  double tolerance_de00 = 0.5;        // what leaving effects out may change, p95 over visible pixels, all together
  double budget_ms = 0;               // of one frame's shading; 0 is none
  double most_ray_samples = 0;        // of all points of a picture; 0 is no limit
  std::string effects = "auto";       // auto, all or none, then +NAME and -NAME, separated by commas
  std::optional<std::string> engine;  // by name; none: the one predicted fastest
  double white_luminance = 1;         // what color differences are relative to
  int samples = 1, frames = 1;
  double pixels = 0;  // of one frame, seen or not; 0: those of the G-buffers
};

// What became of an effect.
enum class Decision { kNotInScene, kDrawn, kDropped, kForcedOn, kForcedOff, kOverBudget };

// As plans, reports and the headers of pictures spell it. image::read_aov_file() reads it back.
const char* spelled(Decision decision);

struct PlanItem {
  std::string effect;
  bool needed = false;  // the scene calls for it
  std::string reason;
  double de00_p95 = 0;  // what leaving it out alone changes
  double cost_ms = 0;   // what it adds to a frame's shading; NaN of engines that draw all effects at once
  bool on = false;
  Decision decision = Decision::kNotInScene;
  std::optional<double> truth_de00_p95;  // the same as de00_p95, by the reference integrator
  std::optional<double> standard_error;  // of de00_p95, where it was measured by random samples
};

// The shading of a frame by one engine, predicted.
struct EnginePrice {
  std::string engine;
  double frame_ms = 0, once_ms = 0;
};

struct Plan {
  std::vector<PlanItem> items;
  Effects effects;
  std::string engine;  // that was chosen
  std::string engine_reason;
  std::vector<EnginePrice> prices;  // of the engines that could be chosen, and of the one that was asked for
  double de00_p95 = 0;              // predicted for all that is left out together
  double time_ms = 0;               // that planning took
  double sums_ms = 0;               // predicted for the sums of the first frame, if they are drawn
  double rays_ms = 0;               // predicted for the effects of rays of one frame that are on
  double ray_pricing_ms = 0;        // of the time that planning took: what the effects of rays are worth
  double path_ms = 0;               // predicted for a frame by rays alone within the tolerance; 0: not priced
  double path_samples = 0;          // of a pixel then, the mean
  double rays_noise_de00 = 0;       // the noise of these that is expected: a standard deviation at 95 of 100 points
  // What the open light as planned misses of the exact sum, at some of the points, with the effects left out that the
  // plan leaves out of it; none where it was not measured.
  std::optional<double> open_de00_p95;
  // Predicted for all that the picture is to miss: open light, effects of rays that are left out, and noise.
  std::optional<double> whole_de00_p95;
  // A sentence where the picture is not going to be within the tolerance: why, and what would be; "" where it is.
  std::string not_kept;

  // Of the engine that was chosen.
  double predicted_ms() const;
};

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
// engine that is asked for must be among them. The effects are tried out by the engine cpu. Error: as for loading that
// engine with all effects of the scene, and as check_effects(). The effects of rays come last in the plan. With a
// transport, all G-buffers must have the triangles of the scene's mesh.
Result<Plan> make_plan(const Scene& scene, const std::vector<std::shared_ptr<const Gbuffer>>& gbuffers,
                       const PlanRequest& request, const std::vector<const Engine*>& engines,
                       const RayContext& rays = {});

// Fills in the truth of every effect that is needed: the change of the exact picture without it, at these points.
void add_truth(Plan& plan, const Scene& scene, const std::vector<VisiblePoint>& points, const envmap::Environment* env,
               double white_luminance);

}  // namespace goniochrome::render
