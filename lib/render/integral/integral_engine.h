// Shades G-buffers without prefiltered maps: at every visible point the environment itself is summed, by blocks of
// texels as coarse as the lobes there allow. goniochrome-theory(7), RENDERING, The integral.
#pragma once

#include <vector>

#include "image/image.h"
#include "render/effects.h"
#include "render/gbuffer.h"
#include "render/internal/visible_point.h"
#include "render/scene.h"

namespace goniochrome::render {

// The spread of blocks (render/reference.h) whose sums are within this color difference, 95 of 100 points; CIEDE2000.
double spread_for(double tolerance_de00);

// Seconds that one of these points takes on all cores together. Where the effects have an environment, the scene has
// its texels.
double integral_seconds_per_point(const std::vector<VisiblePoint>& points, const Scene& scene, const Effects& effects);

// Adds the radiance of all visible points times `gain` to the picture. `places` are those of the G-buffer on textures,
// or empty. Bit-identical for any number of threads.
void add_integral(const Gbuffer& gbuffer, const std::vector<TexturePlace>& places, const Scene& scene,
                  const Effects& effects, float gain, image::Image& rgba);

}  // namespace goniochrome::render
