#include "render/internal/map_cost.h"

#include <algorithm>
#include <bit>

#include "base/parallel.h"
#include "render/internal/maps.h"

namespace goniochrome::render {

namespace {

// The colors of a color map under the scene's lights.
double mapped_point_ns(const Workload& work, const Effects& effects) {
  constexpr double kMapped = 300;
  double directions = 0;
  for (const Light& light : work.scene->lights) directions += static_cast<double>(disc_directions(light).size());
  return effects.maps ? kMapped * directions : 0;
}

double textured_point_ns(const Effects& effects, int lobes, const FilterCost& filter, const TextureCost& cost) {
  const std::uint32_t on = effects.texture_lobes & ((1U << lobes) - 1);
  const double lobe =
      cost.lobe + (effects.environment ? cost.fetches : 0) + static_cast<double>(effects.lights) * cost.lit;
  const double places = !effects.texture_filter ? 1 : cost.each_texel_once ? filter.texels : filter.probes;
  return cost.point + (effects.texture ? 4 : 1) * places * std::popcount(on) * lobe;
}

// Of the ray that goes on behind a pane, and of adding up what it meets.
constexpr double kBehind_ns = 400;

}  // namespace

double point_ns(const Workload& work, const Effects& effects, const MapCost& c) {
  const double spread = effects.anisotropy ? work.tilts : 1;
  double ns = c.point + (effects.depends_on_view() ? c.view : 0);
  if (effects.environment) {
    const bool pairs = c.pairs && !(effects.reflection && work.forms > 4);
    const double single = (effects.diffuse ? 1 : 0) + (effects.mirror ? 1 : 0);
    ns += single * (c.block + c.direction);
    for (const LobeClass& of : lobe_classes(*work.scene->env, effects))
      ns += spread * (c.direction + c.block * static_cast<double>(pairs ? (of.lobes.size() + 1) / 2 : of.lobes.size()));
  }
  double lookups = effects.environment && effects.stretch ? work.stretched : 0;
  if (effects.environment && effects.tilt_level > 0 && !work.lookups.empty())
    lookups += work.lookups[std::min(work.lookups.size(), static_cast<std::size_t>(effects.tilt_level)) - 1];
  if (lookups > 0) ns += c.tilted + lookups * c.lookup;
  return ns +
         static_cast<double>(effects.single_lights()) * (c.light + spread * static_cast<double>(effects.lobes.size()) *
                                                                       (effects.discs() ? c.disc_lobe : c.lit_lobe));
}

double frame_ms(const Workload& work, const Effects& effects, const MapCost& cost) {
  const double texture_ns =
      work.textured > 0 ? textured_point_ns(effects, work.texture_lobes, work.texture_filter, cost.texture) : 0;
  const double behind_ns = effects.panes ? work.behind_pixels * (cost.pixel + kBehind_ns) +
                                               work.behind_points * point_ns(work, effects, cost)
                                         : 0;
  const double ns = behind_ns + work.pixels * cost.pixel + work.points * point_ns(work, effects, cost) +
                    work.textured * texture_ns + work.mapped * mapped_point_ns(work, effects);
  return 1e-6 * work.speed * ns / threads();
}

}  // namespace goniochrome::render
