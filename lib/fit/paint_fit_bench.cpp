// Fitting one paint: microseconds (median, 99.9 % and their ratio) and color error side by side. Time is the thread's
// own, so that other work on the machine does not count.
#include "fit/paint_fit.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <ctime>

namespace goniochrome::fit {
namespace {

double thread_us() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

std::vector<paint::Paint> metallics(int count) {
  std::vector<paint::Paint> paints(count);
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
  const formats::Basis basis = {"b8", {1.3, 3, 6, 20, 70, 250, 900, 3000}, true};
  const auto method = static_cast<FitMethod>(state.range(0));
  const PaintFitter fitter(basis, {.method = method});
  const std::vector<paint::Paint> paints = metallics(1000);
  double gap = 0, mean = 0;
  for (const paint::Paint& paint : paints) {
    const auto fit = fitter.fit(paint);
    if (!fit.ok()) return state.SkipWithError("a paint cannot be fitted");
    gap = std::max(gap, fit->report.optimality_gap);
    mean += fit->report.de00_mean / static_cast<double>(paints.size());
  }
  // deltae ends where no weight can move and gain, not at a proven optimum.
  if (gap > (method == FitMethod::kDeltaE ? 1e-3 : 1e-9)) state.SkipWithError("not optimal");
  std::vector<double> times_us;
  std::size_t i = 0;
  for (auto _ : state) {
    const double before_us = thread_us();
    benchmark::DoNotOptimize(fitter.fit(paints[i++ % paints.size()]));
    times_us.push_back(thread_us() - before_us);
  }
  std::sort(times_us.begin(), times_us.end());
  const double median = times_us[times_us.size() / 2], late = times_us[times_us.size() * 999 / 1000];
  state.counters["median_us"] = median;
  state.counters["p99.9_us"] = late;
  state.counters["p99.9_over_median"] = late / median;
  state.counters["mean_de00"] = mean;
  state.counters["max_gap"] = gap;
}
// l1, l2, deltae; each paint at least five times, so that 99.9 % means something.
BENCHMARK(fit_paint)->ArgName("method")->DenseRange(0, 2)->Iterations(5000)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace goniochrome::fit
