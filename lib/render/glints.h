// Mirror images of lamps that are smaller than what a sample of a pixel sees: the sun in a curved coat fills a part of
// a pixel, and samples at points would find it or miss it by chance. goniochrome-theory(7), RENDERING, Lamps.
#pragma once

#include "image/image.h"
#include "render/effects.h"
#include "render/gbuffer.h"
#include "render/scene.h"

namespace goniochrome::render {

// The share of a lamp's radiance that a mirror shows which looks along `mirrored`, averaged over mirror directions
// within `spread_rad` (the radius of a disc of the solid angle that a sample sees by reflection). The image of the lamp
// is widened by the spread and dimmed by as much, so that it keeps its light. 1 or 0 where the spread is small beside
// the lamp.
double mirrored_share(const Light& light, const Vec3& mirrored, double spread_rad);

// Adds to a picture of engines that look along the mirror direction of each sample what is missing to the average over
// the sample, times `weight`, which is one part in the samples of a pixel.
void add_glints(const Scene& scene, const Effects& effects, const Gbuffer& gbuffer, float weight, image::Image& rgba);

}  // namespace goniochrome::render
