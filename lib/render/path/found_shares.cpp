#include "render/path/found_shares.h"

#include <algorithm>

#include "render/internal/seen.h"

namespace goniochrome::render {

namespace {

// Without direct light, nothing is passed on either.
constexpr unsigned kOfShadow = 0b0111;

}  // namespace

color::Rgb sum_of(const LightShares& shares, unsigned bits) {
  color::Rgb sum;
  for (std::size_t k = 0; k < kShareCount; ++k)
    if ((bits >> k & 1U) != 0) sum += shares.*kShares[k];
  return sum;
}

FoundShares found_shares(const std::vector<SharedPoint>& points, const std::vector<SharedPoint>& smooth,
                         double stop_de00, double white_luminance) {
  const auto change = [&](const std::vector<SharedPoint>& of, unsigned bits) {
    std::vector<double> de00;
    for (const SharedPoint& point : of) {
      const color::Rgb with = point.base + point.shares.sum();
      de00.push_back(seen_difference(with, with - sum_of(point.shares, bits), white_luminance));
    }
    return percentile_95(std::move(de00));
  };
  FoundShares found;
  std::array<double, kShareCount> alone{};
  std::array<std::size_t, kShareCount> order{};
  for (std::size_t k = 0; k < kShareCount; ++k) {
    order[k] = k, alone[k] = change(points, 1U << k);
    found.of[k].de00_p95 = change(smooth, k == 0 ? kOfShadow : 1U << k);
  }
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return alone[k]; });
  for (const std::size_t k : order) {
    const unsigned together = found.stopped | 1U << k;
    const double de00 = change(points, together);
    if (de00 > stop_de00) continue;
    found.stopped = together, found.stopped_de00 = de00;
    found.of[k].stopped = true;
  }
  return found;
}

}  // namespace goniochrome::render
