// Sums and products of covariances of three channels.
#pragma once

#include <algorithm>
#include <cmath>

#include "render/path/noise.h"

namespace goniochrome::render {

// sum + scale c, in place.
inline void add(Covariance& sum, double scale, const Covariance& c) {
  for (std::size_t k = 0; k < 6; ++k) sum[k] += scale * c[k];
}

// d d^T.
inline Covariance outer(const color::Rgb& d) {
  return {d.x * d.x, d.y * d.y, d.z * d.z, d.x * d.y, d.x * d.z, d.y * d.z};
}

// Of values whose channels are multiplied by s.
inline Covariance scaled(const Covariance& c, const color::Rgb& s) {
  return {s.x * s.x * c[0], s.y * s.y * c[1], s.z * s.z * c[2], s.x * s.y * c[3], s.x * s.z * c[4], s.y * s.z * c[5]};
}

// Differences of squares may be negative where little was drawn: nothing is then known of that channel.
inline Covariance not_negative(Covariance c) {
  constexpr std::size_t kPairs[3][2] = {{0, 1}, {0, 2}, {1, 2}};
  for (std::size_t k = 0; k < 3; ++k) c[k] = std::max(c[k], 0.0);
  for (std::size_t k = 0; k < 3; ++k) {
    const double most = std::sqrt(c[kPairs[k][0]] * c[kPairs[k][1]]);
    c[3 + k] = std::clamp(c[3 + k], -most, most);
  }
  return c;
}

}  // namespace goniochrome::render
