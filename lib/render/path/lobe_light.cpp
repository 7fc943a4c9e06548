#include "render/path/lobe_light.h"

namespace goniochrome::render {

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
  bounced = bounces > 0 ? direct : std::vector<std::vector<float>>(columns.count());
  classes.assign(bounces > 0 ? worn.groups.classes() : 0, std::vector<float>(3 * lobes));
}

std::vector<std::uint32_t> LobeTransport::points_of(std::size_t column) const {
  std::vector<std::uint32_t> points;
  for (std::size_t i = 0; i < places.size(); ++i)
    if (column == LobeColumns::diffuse() || has_lobes(i)) points.push_back(static_cast<std::uint32_t>(i));
  return points;
}

}  // namespace goniochrome::render
