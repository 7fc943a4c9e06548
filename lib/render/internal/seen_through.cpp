#include "render/internal/seen_through.h"

#include "render/surface_layer.h"

namespace goniochrome::render {

namespace {

template <class Visit>
void visit_pixels(const BehindPanes& behind, const Visit& visit) {
  for_pixels(behind.gbuffer.width, behind.gbuffer.height, [&](int x, int y) {
    if (const float passed = behind.passed[behind.gbuffer.index(x, y)]; passed > 0) visit(x, y, passed);
  });
}

}  // namespace

BehindSight::BehindSight(const BehindPanes& behind, const SurfaceLayer* layer)
    : gbuffer_(&behind.gbuffer, [](const Gbuffer*) {}) {
  if (layer != nullptr && layer->textured()) places_ = layer->places(behind.gbuffer);
}

void add_behind(const BehindPanes& behind, const image::Image& shown, float gain, image::Image& picture) {
  visit_pixels(behind, [&](int x, int y, float passed) {
    const float* from = shown.pixel(x, y);
    float* to = picture.pixel(behind.x + x, behind.y + y);
    for (int c = 0; c < 4; ++c) to[c] += gain * passed * from[c];
  });
}

void uncover(const BehindPanes& behind, float gain, image::Image& picture) {
  visit_pixels(behind,
               [&](int x, int y, float passed) { picture.pixel(behind.x + x, behind.y + y)[3] -= gain * passed; });
}

}  // namespace goniochrome::render
