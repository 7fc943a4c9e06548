// The light that each lobe of a basis gathers at every visible point, with shadows and bounced light: what a picture is
// linear in. goniochrome-transport(7), "TRANSPORT".
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <vector>

#include "base/result.h"
#include "render/path/lobe_point.h"
#include "render/path/open_light.h"
#include "render/path/visible_surface.h"

namespace goniochrome::render {

// The paints while bounced light was traced: of each group, by column.
struct WornPaints {
  PaintGroups groups;
  std::vector<std::vector<color::Rgb>> weights;
  std::vector<paint::Anisotropy> brushed;  // of each part of the mesh: its lobes are those of such a surface
  // The index of the coat that the base is lit through, for each part of the mesh, then for the floor. The light of a
  // paint under another coat is that of brdf::under_coat().
  std::vector<double> coats;
  std::vector<color::Rgb> emission;  // radiance of each part of the mesh by itself, whatever it wears
  bool has_floor = false;            // as the part after the mesh's
  // True if that floor shows the environment. Its weights are 1 in the diffuse column and 0 elsewhere, for any paint.
  bool floor_is_projected = false;

  bool is_projected(int part) const { return floor_is_projected && part == static_cast<int>(brushed.size()); }
};
// The groups of the scene's parts, and of the floor as one more where there is one. Each part is a group up to
// kMostOwnGroups parts; beyond them parts that wear the same are one. Error: as column_weights(). Of a paint whose
// weights change with the view they are those for all views together.
constexpr std::size_t kMostOwnGroups = 8;
Result<WornPaints> worn_paints(const LobeColumns& columns, const PathScene& scene);

// Visible points evenly spread over the picture, at which bounced light is known by pairs of columns: they tell how
// bounced light follows a change of paint, and by how much scaling it to first order errs.
struct BounceProbe {
  std::uint32_t point = 0;          // of LobeTransport::places
  std::vector<float> once, deeper;  // as LobePoint::Pairs, channels last
};

// Light by column and channel, of weight 1, for the visible points row by row: the mean over those samples of a pixel
// that show the part that its center shows, from the same side.
struct LobeTransport {
  int width = 0, height = 0;
  LobeColumns columns;
  std::vector<std::uint32_t> places;   // y width + x, ascending
  std::vector<float> direct, bounced;  // point, column, channel
  WornPaints worn;
  std::vector<float> classes;       // point, class of PaintGroups, channel: bounced light that the picture showed
  std::vector<float> noise_de00;    // of each point, the largest over the columns: see LobeTransportRequest
  std::vector<int> part;            // of each point
  std::vector<BounceProbe> probes;  // those that see a surface
  int probed = 0;                   // all of them
  double white_luminance = 1;       // of the scene's diffuse white, in the unit that the light is kept in
  double unit = 1;                  // that unit, as radiance
  int bounces = 0;
  int samples = 1;  // of a pixel, as sample_shifts() has them

  std::size_t floats() const { return 3 * columns.count(); }  // of a point
  color::Rgb light(std::size_t point, std::size_t column, bool with_bounced = true) const {
    const std::size_t at = point * floats() + 3 * column;
    color::Rgb sum{direct[at], direct[at + 1], direct[at + 2]};
    if (with_bounced) sum += color::Rgb{bounced[at], bounced[at + 1], bounced[at + 2]};
    return sum;
  }
};

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
