// Time of an index and of a fit of the second paint, checked first: the index against a dense grid, the fit by what it
// leaves.
#include <benchmark/benchmark.h>

#include <cmath>

#include "panels/geometry_sets.h"
#include "panels/trompe.h"

namespace goniochrome::panels {
namespace {

const paint::Appearance kPearl{{75, 20, 30}, {30, -15, 5}, 80, {}};

void index_of_a_pair(benchmark::State& state) {
  const FlakeCurve curve(kPearl);
  const TiltedPair pair = TiltedPair::make({45, -20, static_cast<double>(state.range(0))}, 90);
  const auto found = geometry_index(curve, pair, 2.3, DifferenceMetric::kDe76);
  double grid = 1e-5;
  while (difference_at(curve, pair, grid, DifferenceMetric::kDe76) < 2.3) grid += 1e-5;
  state.counters["error_deg"] = std::abs(*found.plus_deg - grid);
  if (!(*found.plus_deg <= grid && *found.plus_deg > grid - 1.1e-5)) state.SkipWithError("not the first crossing");
  for (auto _ : state) benchmark::DoNotOptimize(geometry_index(curve, pair, 2.3, DifferenceMetric::kDe76));
}
BENCHMARK(index_of_a_pair)->Arg(0)->Arg(40);  // in plane; out of plane

void second_paint(benchmark::State& state) {
  std::vector<PanelView> views;
  const GeometryList list = *geometry_list({.lights = "20:60:10", .views = "as15:105:10"});
  for (const LightView& geometry : list.pairs)
    if (const auto view = panel_view(geometry, 90, 2)) views.push_back(*view);
  TrompeOptions options;
  options.least_maximum = state.range(0) != 0;
  const auto fit = trompe_fit(kPearl, false, views, options);
  state.counters["views"] = static_cast<double>(views.size());
  state.counters["rms_left"] = fit->after.rms;
  if (!(fit->after.rms < 0.2 * fit->before.rms)) state.SkipWithError("the fit does not help");
  for (auto _ : state) benchmark::DoNotOptimize(trompe_fit(kPearl, false, views, options));
}
BENCHMARK(second_paint)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);  // least RMS; least maximum

}  // namespace
}  // namespace goniochrome::panels
