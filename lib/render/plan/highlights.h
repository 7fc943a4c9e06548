// Points at which a part may show the brightest light of a scene. goniochrome-plan(7), "PLAN".
#pragma once

#include <vector>

#include "render/effects.h"
#include "render/gbuffer.h"

namespace goniochrome::render {

// For each part that the points show: points whose mirror direction meets a lamp, a bright spot, or the brightest texel
// of a map, at several angles of incidence. A picture may show any of them between the points of a plan.
std::vector<VisiblePoint> highlight_points(const Scene& scene, const Effects& effects,
                                           const std::vector<VisiblePoint>& points);

}  // namespace goniochrome::render
