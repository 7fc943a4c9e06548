#include "render/gl/gl_weights.h"

#include <algorithm>

#include "render/page_weights.h"

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

}  // namespace goniochrome::render
