#include "render/plan/path_price.h"

#include <algorithm>
#include <cmath>

#include "base/clock.h"
#include "base/parallel.h"
#include "render/internal/seen.h"
#include "render/path/noise.h"

namespace goniochrome::render {

// As path_picture() shares out its samples.
double path_frame_ms(const ProbeSetting& setting, const std::vector<RayPoint>& points, double tolerance_de00,
                     double visible_points) {
  constexpr std::size_t kMost = 192;
  constexpr int kBatches = 6;
  constexpr double kFewest = 1;  // the first round
  if (points.empty() || !(tolerance_de00 > 0)) return 0;
  const std::size_t step = std::max<std::size_t>(1, points.size() / kMost), count = points.size() / step;
  PathOptions options;
  options.bounces = setting.bounces;
  std::vector<double> needed(count);
  const double white = setting.white_luminance > 0 ? setting.white_luminance : 1;
  const Stopwatch clock;
  parallel_for(count, 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const RayPoint& from = points[i * step];
      const PointTransport at(*setting.transport, options, from.spot, from.to_viewer);
      Estimates values;
      for (int k = 0; k < kBatches && !at.certain(); ++k)
        values.add(at.batch(mixed(mixed(setting.seed, 0x7061), i * kBatches + static_cast<std::size_t>(k))));
      if (at.certain()) continue;
      const double one = noise_de00(at.sure() + values.mean(), values.covariance(), white) / tolerance_de00;
      needed[i] = one * one;
    }
  });
  const double batch_ms = 1000 * clock.elapsed_s() / (static_cast<double>(count) * kBatches);
  const double most = std::max(kFewest, 1.05 * percentile_95(needed));
  double batches = 0;
  for (const double n : needed) batches += std::clamp(n, kFewest, most);
  return visible_points * batches / static_cast<double>(count) * batch_ms;
}

}  // namespace goniochrome::render
