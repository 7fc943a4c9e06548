#include "render/path/lobe_light.h"

#include <algorithm>
#include <cmath>

namespace goniochrome::render {

float largest_of(const std::vector<float>& values) {
  float largest = 0;
  for (const float value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

void LobeTransport::make_room(const std::vector<bool>& wanted) {
  with_lobes.clear();
  std::uint32_t lobes = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    with_lobes.push_back(lobes);
    if (has_lobes(i)) ++lobes;
  }
  direct.assign(columns.count(), {});
  for (std::size_t k = 0; k < columns.count(); ++k)
    if (k == LobeColumns::diffuse() || wanted.empty() || wanted[k])
      direct[k].assign(3 * (k == LobeColumns::diffuse() ? places.size() : lobes), 0);
  bounced = direct;
  classes.assign(3 * worn.groups.classes() * lobes, 0);
}

std::vector<std::uint32_t> LobeTransport::points_of(std::size_t column) const {
  std::vector<std::uint32_t> points;
  for (std::size_t i = 0; i < places.size(); ++i)
    if (column == LobeColumns::diffuse() || has_lobes(i)) points.push_back(static_cast<std::uint32_t>(i));
  return points;
}

}  // namespace goniochrome::render
