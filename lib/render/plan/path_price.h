// How long the engine path takes for a frame, told from some of its points. goniochrome-theory(7), PLAN, Effects of
// rays.
#pragma once

#include <vector>

#include "render/plan/ray_probe.h"

namespace goniochrome::render {

// Milliseconds on all cores together until the noise of `visible_points` pixels of the mesh is within the tolerance.
// `points` are some of them. 0 where there are none.
double path_frame_ms(const ProbeSetting& setting, const std::vector<RayPoint>& points, double tolerance_de00,
                     double visible_points);

}  // namespace goniochrome::render
