// Makes plans, see plan.h. goniochrome-plan(7), "PLAN".
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "base/result.h"
#include "render/gbuffer.h"
#include "render/plan.h"
#include "render/scene.h"

namespace goniochrome::envmap {
class Environment;
}

namespace goniochrome::render {

class CpuEngine;
class Engine;
struct CorrectionNoise;

// Up to `count` pixels of which each shows something, evenly spread over those of all G-buffers.
std::vector<ProbePixel> probe_pixels(const std::vector<std::shared_ptr<const Gbuffer>>& gbuffers, std::size_t count);
// The points that they show, with the footprints on textures that one of so many samples of a pixel has; see
// SurfaceLayer::put_places().
std::vector<VisiblePoint> probe_points(const std::vector<ProbePixel>& pixels, const Scene& scene, int samples);

// The scene as far as it is seen: paints of parts that no G-buffer shows are bare, so that nothing is loaded for them.
// Behind panes anything may be seen.
Scene seen_scene(const Scene& scene, const std::vector<std::shared_ptr<const Gbuffer>>& gbuffers);

// Plans the drawing of `scene`, as seen_scene() has it, by one of these engines, of which there is at least one. The
// engine that is asked for must be among them. The effects are tried out by `tried`, whose maps may serve the picture.
// Error: as for loading it with all effects of the scene. Sums and the effects of rays come last in the plan.
Result<Plan> make_plan(const Scene& scene, const std::vector<std::shared_ptr<const Gbuffer>>& gbuffers,
                       const PlanRequest& request, const std::vector<const Engine*>& engines, const RaySetup& rays,
                       CpuEngine& tried);

// Fills in the truth of every effect that is needed: the change of the exact picture without it, at these points; that
// of flakes, where the pixels are given that show the points.
void add_truth(Plan& plan, const Scene& scene, const std::vector<VisiblePoint>& points, const envmap::Environment* env,
               double white_luminance, std::vector<ProbePixel> pixels = {});

// Takes what the first pass of a picture found.
void add_findings(const CorrectionNoise& rays, const FoundMaps& maps, Plan& plan);

}  // namespace goniochrome::render
