// Times of a file for each target, with its error.
#include <benchmark/benchmark.h>

#include "materials/internal/paints_for_test.h"
#include "materials/material.h"

namespace goniochrome::materials {
namespace {

void file_of(benchmark::State& state, const Target* target) {
  const paint::Paint paint = silver_for_test();
  const auto first = target->material(paint, {"silver", "silver", "bench", {}});
  if (!first.ok()) return state.SkipWithError("no file");
  for (auto _ : state) benchmark::DoNotOptimize(target->material(paint, {"silver", "silver", "bench", {}}));
  state.counters["de00_mean"] = first->shown.de00_mean;
  state.counters["bytes"] = static_cast<double>(first->bytes.size());
}
BENCHMARK_CAPTURE(file_of, rgl, &kRgl)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(file_of, mdl, &kMdl)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(file_of, materialx, &kMaterialX)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(file_of, gltf, &kGltf)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(file_of, standard_surface, &kStandardSurface)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(file_of, openpbr, &kOpenPbr)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(file_of, usda, &kUsd)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace goniochrome::materials
