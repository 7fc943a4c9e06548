// The gloss meter: building the table once per basis, and the way from a reading to weights.
#include "brdf/gloss.h"

#include <benchmark/benchmark.h>

#include <cmath>

namespace goniochrome::brdf {
namespace {

const std::vector<double> kBasis = {1.3, 6, 20, 70, 250, 900, 3000};

void gloss_table(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(GlossTable(kBasis));
}
BENCHMARK(gloss_table)->Unit(benchmark::kMicrosecond);

void gloss_inverse(benchmark::State& state) {
  const GlossTable table(kBasis);
  paint::LobeFit fit;
  for (const double e : kBasis) fit.lobes.push_back({e, {}, {}});
  fit.lobes.push_back({paint::kMirrorExponent, {}, {}});
  double worst = 0;
  for (double gu = 1; gu <= 100; ++gu) worst = std::max(worst, std::abs((*set_gloss(table, {{60, gu}}, fit))[0]));
  if (worst > 1e-9) state.SkipWithError("readings are not met");
  for (auto _ : state) benchmark::DoNotOptimize(set_gloss(table, {{60, 72}}, fit));
  state.counters["max_misfit_gu"] = worst;
}
BENCHMARK(gloss_inverse);

}  // namespace
}  // namespace goniochrome::brdf
