#include "render/cost.h"

#include <algorithm>
#include <bit>

namespace goniochrome {

namespace {

// Measured by BM_PaintEdited and BM_Tilts: a part that every point has, one map more, one light more, one lobe in a
// light.
struct Counts {
  double point, map, class_of_maps, light, lit_lobe, view, reflection_map;
};
constexpr Counts kCpu = {20, 4, 8, 12, 5, 4, 2};
constexpr Counts kGl = {100, 47, 0, 40, 30, 12, 8};

}  // namespace

double point_ns(const Effects& effects, Engine engine, double tilts) {
  const Counts& c = engine == Engine::kCpu ? kCpu : kGl;
  const double spread = effects.anisotropy ? tilts : 1;
  double lobes = 0;
  for (const Effects::LobeUse& use : effects.lobes) lobes += use.directional_diffuse || use.gloss ? 1 : 0;
  double ns = c.point + (effects.depends_on_view() ? c.view : 0);
  if (effects.environment) {
    const double single = (effects.diffuse ? 1 : 0) + (effects.mirror ? 1 : 0);
    const double classes = lobes > 0 ? std::min(2.0, lobes) : 0;
    ns += single * (c.map + c.class_of_maps) + spread * (lobes * c.map + classes * c.class_of_maps);
    if (effects.reflection) ns += (single + lobes) * c.reflection_map;
  }
  return ns + static_cast<double>(effects.lights) * (c.light + spread * lobes * c.lit_lobe);
}

// Four texels around a place, each with its lobes, or the mean texel. Measured by BM_Texture: a point, a lobe of a texel,
// its two fetches, its light.
double textured_point_ns(const Effects& effects, int lobes) {
  constexpr double kPoint = 30, kLobe = 6, kFetches = 10, kLit = 3;
  const std::uint32_t on = effects.texture_lobes & ((1U << lobes) - 1);
  const double lobe = kLobe + (effects.environment ? kFetches : 0) + static_cast<double>(effects.lights) * kLit;
  return kPoint + (effects.texture ? 4 : 1) * std::popcount(on) * lobe;
}

}  // namespace goniochrome
