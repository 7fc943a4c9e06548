#include "render/gl/disc_texture.h"

#include <algorithm>
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
    for (int i = 0; i <= kNodes; ++i) {
      const double sine = std::sin(light.radius_rad) * std::min(1.0, 2.0 * i / (kNodes - 1) - 1);
      texels.push_back(static_cast<float>(brdf::disc_irradiance(sine, light.radius_rad)));
      texels.push_back(static_cast<float>(brdf::disc_above(sine, light.radius_rad)));
      texels.insert(texels.end(), {0, 0});
    }
  }
  return texture;
}

Vec3 disc_uniform(const Light& light) {
  const double radius = light.radius_rad;
  if (radius <= 0) return {0, -1, 0};
  return {std::sin(radius), 2 * std::sin(0.5 * radius), light.mirrored ? brdf::disc_radiance(radius) : 0};
}

}  // namespace goniochrome::render
