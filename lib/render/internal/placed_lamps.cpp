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
    std::ranges::copy(from_origin(light.place->position, origin), lamp.position);
    lamp.reach2 = static_cast<float>(reach * reach), lamp.least2 = static_cast<float>(least * least);
    lamp.radius2 = static_cast<float>(radius * radius);
  }
  if (!any) lamps.clear();
  return lamps;
}

Vec3 origin_of(const mesh::Mesh& mesh) {
  return mesh::bounding_box(mesh).middle();
}

std::array<float, 3> from_origin(const Vec3& position, const Vec3& origin) {
  const Vec3 from = position - origin;
  return {static_cast<float>(from.x), static_cast<float>(from.y), static_cast<float>(from.z)};
}

}  // namespace goniochrome::render
