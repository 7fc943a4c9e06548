#include "render/plan/map_audit.h"

#include <algorithm>
#include <vector>

#include "base/clock.h"
#include "render/exact.h"
#include "render/integral/integral_engine.h"
#include "render/internal/seen.h"
#include "render/panes.h"
#include "render/planning.h"
#include "render/scene_effects.h"
#include "render/surface_layer.h"

namespace goniochrome::render {

namespace {

constexpr std::size_t kAudited = 256;
// Sums stop that change no more than this part of the tolerance; the rest is for what else the maps miss.
constexpr double kStopSums = 0.5;
// The part of the tolerance that the blocks of the reference may err by.
constexpr double kOfBlocks = 0.2;

}  // namespace

FoundMaps MapAudit::found(const std::shared_ptr<const Gbuffer>& seen, int samples) const {
  const Stopwatch clock;
  std::vector<VisiblePoint> points = probe_points(probe_pixels({seen}, kAudited), scene, samples);
  std::erase_if(points,
                [&](const VisiblePoint& point) { return is_pane(scene, static_cast<std::size_t>(point.part)); });
  const auto differences = [&](const std::vector<color::Rgb>& a, const std::vector<color::Rgb>& b) {
    std::vector<double> de00(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) de00[i] = seen_difference(a[i], b[i], white_luminance);
    return de00;
  };
  std::vector<color::Rgb> shown = maps.colors(points);
  if (scene.layer != nullptr) scene.layer->add(points, effects, shown);
  FoundMaps found;
  if (sums != nullptr) {
    std::vector<color::Rgb> summed = sums->at(points);
    for (std::size_t i = 0; i < points.size(); ++i) summed[i] += shown[i];
    found.sums_de00_p95 = percentile_95(differences(shown, summed));
    found.sums_stopped = sums_may_stop && *found.sums_de00_p95 <= kStopSums * tolerance_de00;
    if (!found.sums_stopped) shown = std::move(summed);
  }
  if (texels != nullptr)
    found.errors_de00 = differences(
        shown, exact_radiance(points, scene, effects_of(scene), {*texels, spread_for(kOfBlocks * tolerance_de00)}));
  found.ms = 1000 * clock.elapsed_s();
  return found;
}

}  // namespace goniochrome::render
