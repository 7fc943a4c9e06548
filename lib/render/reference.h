// The yardstick: the exact BRDF against the full-resolution environment, summed directly in double precision, without
// any prefiltering. goniochrome-theory(7), REFERENCE INTEGRATOR.
#pragma once

#include <cstdint>
#include <vector>

#include "envmap/environment.h"
#include "image/image.h"
#include "render/renderer.h"
#include "render/scene.h"

namespace goniochrome {

struct SurfacePoint {
  Vec3 normal, to_viewer;  // unit, on the same side
  const LobeFit* paint = nullptr;
};

// The radiance of each point, in the working space: the integral of f L cos_i over the texels above the horizon, each a
// constant patch with its exact solid angle, cut finer where a lobe is narrower than a texel; the mirror lobe's Fresnel
// times the texel that it sees; and the lights. `env` may be null. Bit-identical for any number of threads.
std::vector<Rgb> reference_radiance(const std::vector<SurfacePoint>& points, const Environment* env,
                                    const std::vector<Light>& lights);

// How far a picture is from the reference.
struct PictureError {
  int checked_pixels = 0;
  double de00_mean = 0, de00_p95 = 0, de00_max = 0;
  int worst_x = 0, worst_y = 0;
  double time_s = 0;
};

// Compares the centers of `count` random visible pixels (all, where there are fewer) with the reference, as CIEDE2000
// of Lab values relative to `white_luminance`, D65. The frame must hold its centers.
PictureError picture_error(const Frame& frame, const Scene& scene, const Environment* env, double white_luminance,
                           int count, std::uint64_t seed);

}  // namespace goniochrome
