#include "render/internal/placed_lamps.h"

#include <algorithm>

#include "math/elementary.h"

namespace goniochrome::render {

std::vector<PlacedLamp> placed_lamps(const std::vector<Light>& lights, const Vec3& origin) {
  std::vector<PlacedLamp> lamps;
  bool any = false;
  for (const Light& light : lights) {
    PlacedLamp& lamp = lamps.emplace_back();
    if (!light.place) continue;
    any = true;
    const double reach = light.place->distance, radius = reach * math::sin(light.radius_rad);
    const double least = std::max(radius, kNearestPoint * reach);
    lamp.position = floats(light.place->position - origin);
    lamp.reach2 = static_cast<float>(reach * reach), lamp.least2 = static_cast<float>(least * least);
    lamp.radius2 = static_cast<float>(radius * radius);
  }
  if (!any) lamps.clear();
  return lamps;
}

Vec3 origin_of(const mesh::Mesh& mesh) {
  return mesh::bounding_box(mesh).middle();
}

}  // namespace goniochrome::render
