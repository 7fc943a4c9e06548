// Traces the light that each lobe of a basis gathers at every visible point. goniochrome-transport(7), "TRANSPORT".
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <vector>

#include "base/result.h"
#include "render/path/lobe_light.h"  // IWYU pragma: export
#include "render/path/open_light.h"
#include "render/path/visible_surface.h"

namespace goniochrome::render {

// The groups of the scene's parts, and of the floor as one more where there is one. Each part is a group up to
// kMostOwnGroups parts; beyond them parts that wear the same are one. Error: as column_weights(). Of a paint whose
// weights change with the view they are those for all views together.
constexpr std::size_t kMostOwnGroups = 8;
Result<WornPaints> worn_paints(const LobeColumns& columns, const PathScene& scene);

struct LobeTransportRequest {
  int bounces = 8;
  // Samples are added until TracedLobes::error_p95_de00 is within it.
  double tolerance_de00 = 0.5;
  double time_limit_s = 0;  // 0: none
  int most_batches = 2048;  // of a point
  double white_luminance = 1;
  int probes = 256;       // at most, at pixel centers
  int pixel_samples = 1;  // LobeTransport::samples
  std::uint64_t seed = 1;
  std::function<void(double error_de00, double seconds)> progress = {};
};

struct TracedLobes {
  LobeTransport transport;
  double error_p95_de00 = 0;  // what 5 of 100 errors exceed in the paints that are worn, before white_luminance
  // The noise of a column is what its random error changes in the gray paint of nominal_weight(), one standard
  // deviation. That of a point is the largest over its columns. Errors of columns cancel in part in a paint: on a car
  // the noisiest column had five times the error of the paint, and other paints 0.9 to 1.5 times that of the one worn.
  double noise_p95_de00 = 0, noise_mean_de00 = 0;
  double samples_mean = 0, free_share = 0;  // directions of a point; points that samples tell nothing of
  double time_s = 0;
  bool reached = false;
};

// `open` null: rays alone, which is noisier and has no error of maps. Bit-identical for any number of threads while no
// time limit ends it.
TracedLobes traced_lobes(const Transport& transport, const Gbuffer& surface, const LobeColumns& columns,
                         const WornPaints& worn, const OpenLight* open, const LobeTransportRequest& request);

}  // namespace goniochrome::render
