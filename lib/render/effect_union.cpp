#include "render/effect_union.h"

#include <fmt/core.h>

#include <algorithm>

#include "base/text.h"

namespace goniochrome::render {

namespace {

void add_lobe(const Effects::LobeUse& use, std::vector<Effects::LobeUse>& lobes) {
  const auto at = std::ranges::lower_bound(lobes, use.exponent, {}, &Effects::LobeUse::exponent);
  if (at == lobes.end() || at->exponent != use.exponent) {
    lobes.insert(at, use);
    return;
  }
  at->directional_diffuse |= use.directional_diffuse;
  at->gloss |= use.gloss;
}

}  // namespace

Effects united(const Effects& a, const Effects& b) {
  Effects all = a;
  for (const Effects::LobeUse& use : b.lobes) add_lobe(use, all.lobes);
  for (const auto flag : {&Effects::environment, &Effects::diffuse, &Effects::mirror, &Effects::fresnel, &Effects::coat,
                          &Effects::horizon, &Effects::views, &Effects::satin, &Effects::stretch, &Effects::maps,
                          &Effects::image_maps, &Effects::texture, &Effects::texture_filter, &Effects::anisotropy,
                          &Effects::reflection, &Effects::extent, &Effects::panes, &Effects::sums})
    all.*flag = a.*flag || b.*flag;
  for (const auto flag : {&RayEffects::shadow, &RayEffects::self, &RayEffects::bounce, &RayEffects::floor})
    all.rays.*flag = a.rays.*flag || b.rays.*flag;
  all.tilt_level = std::max(a.tilt_level, b.tilt_level);
  all.spots = all.tilt_level > 0 || all.maps ? 0 : std::max(a.spots, b.spots);
  all.texture_lobes = a.texture_lobes | b.texture_lobes;
  all.lights = std::max(a.lights, b.lights);
  all.tilt_tolerance = std::min(a.tilt_tolerance, b.tilt_tolerance);
  all.most_tilts = std::max(a.most_tilts, b.most_tilts);
  all.tolerance_de00 = std::min(a.tolerance_de00, b.tolerance_de00);
  all.most_ray_samples = std::max(a.most_ray_samples, b.most_ray_samples);
  if (all.background == Background::kNone) all.background = b.background;
  return all;
}

bool covers(const Effects& all, const Effects& wanted) {
  return united(all, wanted) == all;
}

Effects with_all_lobes(const Effects& effects, const envmap::PrefilteredEnvironment& env) {
  Effects all = effects;
  for (const auto& lobe : env.lobes) {
    // The file holds a float, and the basis has the few digits of which that float is the nearest.
    const auto written = parse_number(fmt::format("{}", static_cast<float>(lobe.exponent)));
    add_lobe({written.value_or(lobe.exponent), true, true}, all.lobes);
  }
  return all;
}

}  // namespace goniochrome::render
