// A picture against path traced truth: exact sums of the open light, and paths for all that the mesh does to it. The
// difference is told by its causes. goniochrome-plan(7), "Check".
#pragma once

#include <cstdint>
#include <optional>

#include "base/result.h"
#include "render/exact.h"
#include "render/picture_error.h"

namespace goniochrome::render {

// CIEDE2000, 95th percentiles over the checked pixels. Each is what that cause alone changes in the truth.
struct TruthShares {
  double prefilter = 0;  // maps, their look-up, and the effects of open light that the plan left out
  double occlusion = 0;  // shadow and self, where the plan left them out
  double bounce = 0;     // the same of bounce
  double noise = 0;      // of the effects of rays that were drawn: their samples, and the light that these met
  double fit = 0;  // what the paints of the pixels miss of their own readings in the mean, as their files tell; it
                   // is not part of the difference
};

// The change by each effect of rays in the truth, as a plan has it: the change by leaving it out, noise taken off.
struct TrueWorth {
  double shadow = 0, self = 0, bounce = 0;
  double floor = 0;  // 0 where the scene has none
};

struct TruthError {
  PictureError total;
  double standard_error = 0;  // of the truth itself: the 95th percentile of its noise
  bool sharp = false;         // whether that is below a tenth of total.de00_p95, or small beside the tolerance
  TruthShares shares;
  TrueWorth worth;  // 0 where the picture was drawn by paths alone
};

struct TruthRequest {
  const envmap::Environment* environment = nullptr;
  double white_luminance = 1;
  int count = 100;
  double tolerance_de00 = 0;  // of the picture: noise of the truth below a twentieth of it is small
  int bounces = 8;
  std::uint64_t seed = 1;
  // Batches of 16 directions: of every pixel, and of those that are noisier than they may be.
  int batches = 256, most_batches = 262144;
  // The picture was drawn by paths alone, which have the mesh in the way from the beginning: all of its error is noise.
  bool whole = false;
};

// Compares the centers of `count` random visible pixels. The frame must hold its centers, with and without the effects
// of rays, and its G-buffer must have triangles of the scene's mesh; the scene must be whole. Error: as
// Transport::create().
Result<TruthError> truth_error(const Frame& frame, const Scene& scene, const RayEffects& drawn,
                               const TruthRequest& request);

}  // namespace goniochrome::render
