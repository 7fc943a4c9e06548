#include "render/cost.h"

#include <algorithm>
#include <bit>

namespace goniochrome {

namespace {

// Measured by BM_PaintEdited and BM_Tilts: a pixel of the picture, seen or not (it is written, and read
// back from OpenGL), a part that every point has, one map more, one light more, one lobe in a light.
struct Counts {
  double pixel, point, map, class_of_maps, light, lit_lobe, view;
};
constexpr Counts kCpu = {2.5, 6, 1.5, 6, 12, 5, 2};
constexpr Counts kGl = {12, 30, 42, 0, 40, 30, 12};

}  // namespace

double pixel_ns(Engine engine) {
  return engine == Engine::kCpu ? kCpu.pixel : kGl.pixel;
}

double point_ns(const Effects& effects, Engine engine, double tilts) {
  const Counts& c = engine == Engine::kCpu ? kCpu : kGl;
  const double spread = effects.anisotropy ? tilts : 1;
  double lobes = 0, shifted = 0;
  for (const Effects::LobeUse& use : effects.lobes) {
    if (!use.directional_diffuse && !use.gloss) continue;
    ++lobes;
    shifted += is_shifted(effects, use.exponent) ? 1 : 0;
  }
  double ns = c.point + (effects.depends_on_view() ? c.view : 0);
  if (effects.environment) {
    const double single = (effects.diffuse ? 1 : 0) + (effects.mirror ? 1 : 0);
    const double classes = shifted + std::min(2.0, lobes - shifted);
    ns += single * (c.map + c.class_of_maps) + spread * (lobes * c.map + classes * c.class_of_maps);
  }
  return ns + static_cast<double>(effects.lights) * (c.light + spread * lobes * c.lit_lobe);
}

// Four texels around a place, each with its lobes, or the mean texel. Measured by BM_Texture: a point, a lobe of a
// texel, its two fetches, its light.
double textured_point_ns(const Effects& effects, int lobes) {
  constexpr double kPoint = 30, kLobe = 6, kFetches = 10, kLit = 3;
  const std::uint32_t on = effects.texture_lobes & ((1U << lobes) - 1);
  const double lobe = kLobe + (effects.environment ? kFetches : 0) + static_cast<double>(effects.lights) * kLit;
  return kPoint + (effects.texture ? 4 : 1) * std::popcount(on) * lobe;
}

}  // namespace goniochrome
