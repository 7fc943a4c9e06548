// The reference for every prefiltered map: the sum over all texels of the environment in double precision, each texel a
// patch of constant radiance. It is slow and exact. goniochrome-prefiltering(7), "The reference".
#pragma once

#include <cstdint>

#include "base/vec3.h"
#include "envmap/environment.h"
#include "envmap/prefiltered.h"

namespace goniochrome::prefilter {

class ZonalKernel;

// P_E(d) per channel, summed texel by texel. Of the mirror it is the radiance of the texel that d falls in.
Vec3 reference_lobe(const envmap::Environment& env, const Vec3& d, double exponent);
// The reference for any kernel (internal/kernel.h).
Vec3 reference_lobe(const envmap::Environment& env, const Vec3& d, const ZonalKernel& kernel);

// The reference for the mirror part of a prefiltered environment: the mean radiance over a texel of a grid in the scene
// that `turn` brings the environment to. It is found by looking up single directions, and the texel is cut where those
// of the environment meet.
Vec3 reference_mirror(const envmap::Environment& env, const envmap::SphereGrid& grid, const envmap::Rotation& turn,
                      int column, int row);

// The share of a map's mean below which errors are no longer relative to the value itself: see LobeError.
inline constexpr double kErrorFloor = 1e-3;

// How far a lobe's map, in the scene that `turn` brings the environment to, is from the reference on `count` random
// texels, `extremes` of its brightest and as many of its darkest: relative, per channel, to the larger of the local
// value and 1e-3 of the channel's mean over the map (1e-6 of the largest channel's mean, where a channel is almost
// empty).
struct LobeError {
  double max = 0, mean = 0;
  int texels = 0;
};
LobeError lobe_error(const envmap::Environment& env, const envmap::PrefilteredLobe& lobe, int count, int extremes,
                     std::uint64_t seed, const envmap::Rotation& turn = {});
// The error of a map that another kernel made.
LobeError lobe_error(const envmap::Environment& env, const envmap::PrefilteredLobe& lobe, const ZonalKernel& kernel,
                     int count, int extremes, std::uint64_t seed, const envmap::Rotation& turn = {});

}  // namespace goniochrome::prefilter
