#include "render/gl/gl_weights.h"

#include <algorithm>

#include "render/page_weights.h"
#include "render/scene_effects.h"

namespace goniochrome::render {

std::vector<float> gl_weights(const WeightTable& table, const ProductForms& forms) {
  std::vector<float> weights = table.rgba;
  if (forms.count != 4) return weights;
  const auto met = static_cast<std::size_t>(table.light_slot()) * 8, slots = static_cast<std::size_t>(table.slots) * 8;
  for (std::size_t at = 0; at < weights.size(); at += slots)
    std::ranges::copy(in_four_forms(forms, &table.rgba[at], met / 4, 4), &weights[at]);
  return weights;
}

std::vector<float> page_weights(const Scene& scene, const Effects& effects) {
  return gl_weights(weight_table(scene, effects),
                    effects.reflection ? product_forms(scene.reflection) : ProductForms{});
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
