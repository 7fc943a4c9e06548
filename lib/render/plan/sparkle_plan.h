// The effect sparkle of a plan. goniochrome-plan(7), "PLAN".
#pragma once

#include <vector>

#include "render/plan.h"

namespace goniochrome::render {

constexpr const char* kSparkleName = "sparkle";

// Predicts what flakes change at the pixels: by one standard deviation, at 95 of 100 of them. Turns the effect on where
// that is more than the tolerance.
PlanItem sparkle_item(const Scene& scene, const std::vector<ProbePixel>& pixels, const PlanRequest& request,
                      Effects& effects);

// The true change, from flakes that are drawn: the root mean square over some pixels around each of these, at 95 of 100
// of them. Light is as if nothing were in its way.
double sparkle_truth(const Scene& scene, const Effects& effects, const std::vector<ProbePixel>& pixels,
                     double white_luminance);

// The item of an engine that draws no flakes.
PlanItem sparkle_left_out(const Scene& scene, const char* engine);

}  // namespace goniochrome::render
