#include "render/plan/cost.h"

#include <bit>

#include "render/internal/maps.h"

namespace goniochrome::render {

namespace {

// Measured by BM_PaintEdited and BM_Tilts: a pixel of the picture, seen or not (it is written, and read
// back from OpenGL), a part that every point has, one block of maps more (two on the processor, one in OpenGL), one
// direction more that maps are met by, one light more, one lobe in a light.
struct Counts {
  double pixel, point, block, direction, light, lit_lobe, view;
};
constexpr Counts kCpu = {2.5, 6, 3, 6, 12, 5, 2};
constexpr Counts kGl = {12, 30, 42, 0, 40, 30, 12};

}  // namespace

double pixel_ns(Engine engine) {
  return engine == Engine::kCpu ? kCpu.pixel : kGl.pixel;
}

double point_ns(const Scene& scene, const Effects& effects, Engine engine, const PointCounts& counts) {
  const Counts& c = engine == Engine::kCpu ? kCpu : kGl;
  const double spread = effects.anisotropy ? counts.tilts : 1;
  double ns = c.point + (effects.depends_on_view() ? c.view : 0);
  if (effects.environment) {
    const bool pairs = engine == Engine::kCpu && !(effects.reflection && counts.forms > 4);
    const double single = (effects.diffuse ? 1 : 0) + (effects.mirror ? 1 : 0);
    ns += single * (c.block + c.direction);
    for (const LobeClass& of : lobe_classes(*scene.env, effects))
      ns += spread * (c.direction + c.block * static_cast<double>(pairs ? (of.lobes.size() + 1) / 2 : of.lobes.size()));
  }
  return ns + static_cast<double>(effects.lights) *
                  (c.light + spread * static_cast<double>(effects.lobes.size()) * c.lit_lobe);
}

double mapped_point_ns(const Effects& effects) {
  constexpr double kMapped = 300;
  return effects.maps ? kMapped * static_cast<double>(effects.lights) : 0;
}

// Four texels around a place, each with its lobes, or the mean texel. Measured by BM_Texture: a point, a lobe of a
// texel, its two fetches, its light.
double textured_point_ns(const Effects& effects, int lobes) {
  constexpr double kPoint = 30, kLobe = 6, kFetches = 10, kLit = 3;
  const std::uint32_t on = effects.texture_lobes & ((1U << lobes) - 1);
  const double lobe = kLobe + (effects.environment ? kFetches : 0) + static_cast<double>(effects.lights) * kLit;
  return kPoint + (effects.texture ? 4 : 1) * std::popcount(on) * lobe;
}

}  // namespace goniochrome::render
