// The light of one point by paths, for references and tests. goniochrome-paths(7), "PATHS".
#pragma once

#include <cstdint>

#include "render/path/noise.h"
#include "render/path/transport.h"

namespace goniochrome::render {

// One point: the mean of so many batches and the covariance of its error.
struct PathEstimate {
  color::Rgb radiance;
  Covariance covariance{};
};
PathEstimate path_estimate(const Transport& transport, const PathOptions& options, const rays::Spot& spot,
                           const Vec3& to_viewer, int batches, std::uint64_t seed);

}  // namespace goniochrome::render
