#include "render/effects.h"

namespace goniochrome::render {

std::vector<Light> lights_of(const Scene& scene, const Effects& effects) {
  if (effects.lights == 0) return {};
  std::vector<Light> lights = scene.lights;
  if (!effects.extent)
    for (Light& light : lights) light.radius_rad = 0;
  return lights;
}

WeightTable slots_of(const Effects& effects) {
  WeightTable table;
  table.lobes = static_cast<int>(effects.lobes.size());
  table.segments = effects.depends_on_view() ? kViewSegments : 1;
  table.slots = table.lamp_mirror_slot() + 1;
  return table;
}

}  // namespace goniochrome::render
