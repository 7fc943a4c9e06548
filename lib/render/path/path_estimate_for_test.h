// The light of one point by paths. goniochrome-paths(7), "PATHS".
#pragma once

#include <cstdint>

#include "render/path/noise.h"
#include "render/path/point_transport.h"

namespace goniochrome::render {

// One point: the mean of so many batches and the covariance of its error.
struct PathEstimate {
  color::Rgb radiance;
  Covariance covariance{};
};
inline PathEstimate path_estimate(const Transport& transport, const PathOptions& options, const rays::Spot& spot,
                                  const Vec3& to_viewer, int batches, std::uint64_t seed) {
  const PointTransport at(transport, options, spot, rays::float3(to_viewer));
  if (at.certain()) return {at.deterministic(), {}};
  Estimates sums;
  for (int k = 0; k < batches; ++k)
    sums.add(at.batch_shares(mixed(mixed(seed, 0), static_cast<std::uint64_t>(k))).sum());
  Covariance covariance = sums.covariance();
  for (double& element : covariance) element /= batches;
  return {at.deterministic() + sums.mean(), covariance};
}

}  // namespace goniochrome::render
