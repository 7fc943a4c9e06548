// Every texel against every direction in float, all lobes at once: what the prefilter is measured against.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "base/vec3.h"
#include "envmap/environment.h"

namespace goniochrome::prefilter {

class AllPairs {
 public:
  static constexpr std::array<double, 7> kExponents = {1, 6, 20, 70, 250, 900, 3000};
  explicit AllPairs(const envmap::Environment& env);

  // P_E at each direction for each exponent: RGB at [3 * (7 * direction + exponent)]. Texels count as points at their
  // centers.
  std::vector<float> lobes(const std::vector<Vec3>& directions) const;

 private:
  std::size_t count_ = 0;                              // padded with texels of no flux
  std::vector<float> x_, y_, z_, red_, green_, blue_;  // of each texel: direction, flux
};

}  // namespace goniochrome::prefilter
