// Fitting one paint: microseconds (median and 99.9 %) and color error side by side.
#include "fit/paint_fit.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

namespace goniochrome {
namespace {

std::vector<Paint> metallics(int count) {
  std::vector<Paint> paints(count);
  for (int i = 0; i < count; ++i) {
    const double t = i / static_cast<double>(count);
    paints[i].measurement.emplace();
    for (const double angle : {15.0, 25.0, 45.0, 75.0, 110.0}) {
      const double flop = std::exp(-(angle - 15) / (20 + 30 * t));
      paints[i].measurement->rows.push_back(
          {{.aspecular_deg = angle}, {10 + 20 * t + (60 + 40 * t) * flop, 30 * std::cos(7 * t), 30 * std::sin(9 * t)}});
    }
    paints[i].gloss = {{60, 50 + 50 * t}};
  }
  return paints;
}

void fit_paint(benchmark::State& state) {
  const Basis basis = {"b8", {1.3, 3, 6, 20, 70, 250, 900, 3000}, true};
  const FitMethod method = state.range(0) == 1 ? FitMethod::kL1 : FitMethod::kL2;
  const PaintFitter fitter(basis, {.method = method});
  const std::vector<Paint> paints = metallics(1000);
  double gap = 0, mean = 0;
  for (const Paint& paint : paints) {
    const auto fit = fitter.fit(paint);
    if (!fit.ok()) return state.SkipWithError("a paint cannot be fitted");
    gap = std::max(gap, fit->report.optimality_gap);
    mean += fit->report.de00_mean / static_cast<double>(paints.size());
  }
  if (gap > 1e-9) state.SkipWithError("not optimal");
  std::vector<double> times_us;
  std::size_t i = 0;
  for (auto _ : state) times_us.push_back(fitter.fit(paints[i++ % paints.size()])->report.time_us);
  std::sort(times_us.begin(), times_us.end());
  state.counters["median_us"] = times_us[times_us.size() / 2];
  state.counters["p99.9_us"] = times_us[times_us.size() * 999 / 1000];
  state.counters["mean_de00"] = mean;
  state.counters["max_gap"] = gap;
}
BENCHMARK(fit_paint)->ArgName("l")->Arg(1)->Arg(2)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace goniochrome

BENCHMARK_MAIN();
