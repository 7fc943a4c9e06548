#include "render/internal/placed_lamps.h"

#include <algorithm>

#include "math/elementary.h"
#include "render/effects.h"
#include "render/surface_layer.h"

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
  const mesh::Box box = mesh::bounding_box(mesh);
  return 0.5 * (box.low + box.high);
}

std::array<float, 3> from_origin(const Vec3& position, const Vec3& origin) {
  const Vec3 from = position - origin;
  return {static_cast<float>(from.x), static_cast<float>(from.y), static_cast<float>(from.z)};
}

Result<void> draws_placed_lamps(const Scene& scene, const char* engine) {
  const bool any = std::ranges::any_of(
      scene.lights, [](const Light& light) { return light.place.has_value() && light.radius_rad > 0; });
  if (!any || !effects_of(scene).extent) return {};
  for (std::size_t part = 0; part < scene.paints.size(); ++part) {
    const paint::LobeFit& paint = scene.paints[part];
    if (paint.lobes.empty() && paint.views.empty() && paint.diffuse == color::Rgb{}) continue;
    if (scene.layer != nullptr && scene.layer->surface(static_cast<int>(part)).hides_paint()) continue;
    return usage_error(
        "the engine {} draws a lamp at a place that shines on paint as a point: write @0 behind the lamp, or take the "
        "engine path, which draws it with its extent",
        engine);
  }
  return {};
}

}  // namespace goniochrome::render
