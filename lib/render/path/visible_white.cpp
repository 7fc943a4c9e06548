#include "render/path/visible_white.h"

#include <algorithm>
#include <vector>

#include "base/parallel.h"
#include "math/statistics.h"
#include "render/path/point_transport.h"

namespace goniochrome::render {

namespace {

constexpr std::size_t kPoints = 256;
constexpr std::uint64_t kBatches = 4;

}  // namespace

double visible_white(const Transport& transport, const Gbuffer& g, int bounces, std::uint64_t seed) {
  const rays::RayScene& scene = transport.rays();
  std::vector<std::size_t> lit;
  for (std::size_t i = 0; i < g.triangles.size(); ++i) {
    if (g.triangles[i] == kNoTriangle) continue;
    if (transport.emitters().radiance(scene.part(g.triangles[i])) == color::Rgb{}) lit.push_back(i);
  }
  if (lit.empty()) return 0;
  PathOptions options;
  options.bounces = bounces;
  options.white = true;
  const std::size_t count = std::min(kPoints, lit.size());
  std::vector<double> luminance(count);
  parallel_each(count, 8, [&](std::size_t k) {
    const std::size_t i = lit[(2 * k + 1) * lit.size() / (2 * count)];
    const int x = static_cast<int>(i % static_cast<std::size_t>(g.width)),
              y = static_cast<int>(i / static_cast<std::size_t>(g.width));
    const PointTransport at(transport, options, spot_at(scene, g, x, y), rays::float3(g.to_viewer(x, y)));
    color::Rgb white = at.deterministic();
    for (std::uint64_t batch = 0; batch < kBatches && !at.certain(); ++batch)
      white += (1.0 / kBatches) * at.batch_shares(mixed(mixed(seed, i), batch)).sum();
    luminance[k] = color::luminance(white);
  });
  return math::median(std::move(luminance));
}

}  // namespace goniochrome::render
