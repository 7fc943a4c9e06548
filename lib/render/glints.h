// Mirror images of lamps that are smaller than what a sample of a pixel sees: the sun in a curved coat fills a part of
// a pixel, and samples at points would find it or miss it by chance. goniochrome-rendering(7), "LAMPS".
#pragma once

#include "base/vec3.h"
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

// The change of a direction from a pixel to the next one by (dx,dy), by the neighbors at both of its sides, or by the
// one that shows the same part; 0 where neither does. at(x, y) is the direction at a pixel, and same(x, y) says whether
// there is a pixel that shows the part.
template <class At, class Same>
Vec3 change_beside(const At& at, const Same& same, int x, int y, int dx, int dy) {
  const bool after = same(x + dx, y + dy), before = same(x - dx, y - dy);
  const Vec3 to = after ? at(x + dx, y + dy) : at(x, y), from = before ? at(x - dx, y - dy) : at(x, y);
  return (after && before ? 0.5 : 1.0) * (to - from);
}

// The radius of a disc of the solid angle that a pixel sees by reflection, where the mirror direction changes by
// `right` and `down` toward its neighbors.
double mirror_spread(const Vec3& right, const Vec3& down);

// Adds to a picture of engines that look along the mirror direction of each sample what is missing to the average over
// the sample, times `weight`, which is one part in the samples of a pixel.
void add_glints(const Scene& scene, const Effects& effects, const Gbuffer& gbuffer, float weight, image::Image& rgba);

}  // namespace goniochrome::render
