#include "render/path/lobe_light.h"

#include "base/parallel.h"

namespace goniochrome::render {

void LobeTransport::make_room(const std::vector<bool>& wanted) {
  with_lobes.resize(places.size());
  std::uint32_t lobes = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    with_lobes[i] = lobes;
    if (has_lobes(i)) ++lobes;
  }
  const std::size_t count = columns.count();
  direct.assign(count, {}), bounced.assign(count, {}), classes.assign(bounces > 0 ? worn.groups.classes() : 0, {});
  parallel_each(2 * count + classes.size(), 1, [&](std::size_t n) {
    if (n >= 2 * count) return classes[n - 2 * count].assign(3 * lobes, 0);
    const std::size_t k = n / 2, points = k == LobeColumns::diffuse() ? places.size() : lobes;
    if (k != LobeColumns::diffuse() && !wanted.empty() && !wanted[k]) return;
    if (n % 2 == 0 || bounces > 0) (n % 2 == 0 ? direct : bounced)[k].assign(3 * points, 0);
  });
}

std::vector<std::uint32_t> LobeTransport::points_of(std::size_t column) const {
  std::vector<std::uint32_t> points;
  points.reserve(places.size());
  for (std::size_t i = 0; i < places.size(); ++i)
    if (column == LobeColumns::diffuse() || has_lobes(i)) points.push_back(static_cast<std::uint32_t>(i));
  return points;
}

}  // namespace goniochrome::render
