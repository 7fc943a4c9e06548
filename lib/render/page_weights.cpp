#include "render/page_weights.h"

#include <algorithm>

#include "render/scene_effects.h"

namespace goniochrome::render {

std::vector<float> page_weights(const Scene& scene, const Effects& effects) {
  return weight_table(scene, effects).rgba;
}

std::vector<float> tilt_texels(const std::vector<std::vector<brdf::Tilt>>& tilts) {
  std::size_t most = 1;
  for (const std::vector<brdf::Tilt>& part : tilts) most = std::max(most, part.size());
  std::vector<float> texels(4 * most * tilts.size(), 0.0F);
  for (std::size_t part = 0; part < tilts.size(); ++part) {
    float* to = &texels[4 * most * part];
    for (const brdf::Tilt& tilt : tilts[part]) {
      for (int c = 0; c < 3; ++c) *to++ = static_cast<float>(tilt.normal[c]);
      *to++ = static_cast<float>(tilt.weight);
    }
  }
  return texels;
}

}  // namespace goniochrome::render
