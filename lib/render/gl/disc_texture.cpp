#include "render/gl/disc_texture.h"

#include <cmath>

#include "brdf/disc_light.h"

namespace goniochrome::render {

FloatTexture disc_texture(const std::vector<Light>& lights, const Effects& effects) {
  constexpr int kNodes = brdf::DiscLobeTable::kNodes;
  FloatTexture texture{kNodes + 1, static_cast<int>((effects.lobes.size() + 1) * lights.size()), {}};
  std::vector<float>& texels = texture.rgba;
  for (const Light& light : lights) {
    for (const Effects::LobeUse& lobe : effects.lobes) {
      const auto table = brdf::disc_lobe_table(lobe.exponent, light.radius_rad);
      for (int i = 0; i < kNodes; ++i) {
        const brdf::DiscLobeTable::Node& node = table->nodes[static_cast<std::size_t>(i)];
        texels.insert(texels.end(), {node.cosine[0], node.cosine[1], node.plain[0], node.plain[1]});
      }
      texels.insert(texels.end(), {static_cast<float>(table->first_chord), static_cast<float>(table->nodes_per_chord)});
      texels.insert(texels.end(), {0, 0});
    }
    for (const auto& [irradiance, above] : brdf::disc_horizon_table(light.radius_rad)->nodes)
      texels.insert(texels.end(), {irradiance, above, 0, 0});
  }
  return texture;
}

Vec3 disc_uniform(const Light& light) {
  const double radius = light.radius_rad;
  if (radius <= 0) return {0, -1, 0};
  return {std::sin(radius), 2 * std::sin(0.5 * radius), light.mirrored ? brdf::disc_radiance(radius) : 0};
}

}  // namespace goniochrome::render
