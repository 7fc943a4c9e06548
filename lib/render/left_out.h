// This header measures what a plan left out: it compares the picture as planned with the picture of all effects, both
// drawn by the engine of the plan. The effects of rays are in neither of them. goniochrome-plan(7), "Check".
#pragma once

#include "base/result.h"
#include "render/renderer.h"

namespace goniochrome::render {

struct LeftOut {
  double de00_mean = 0, de00_p95 = 0, de00_max = 0;  // over all visible pixels; 0 where nothing was left out
  double planned_ms = 0, full_ms = 0;                // one sample of each pixel, the view fixed: the least of some runs
};

// `scene` as seen_scene() has it, and the plan made for it; `view` is drawn with one sample a pixel. The renderer is
// left as planned. Error: as Renderer::load().
Result<LeftOut> left_out(Renderer& renderer, const Scene& scene, const Plan& plan, View view, double white_luminance);

}  // namespace goniochrome::render
