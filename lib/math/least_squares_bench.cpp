// Small non-negative fits: microseconds and error side by side. Correctness is checked before anything is timed.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <random>

#include "math/internal/problems_for_test.h"
#include "math/least_squares.h"

namespace goniochrome::math {
namespace {

template <NonNegativeFit (*solve)(const Matrix&, const std::vector<double>&)>
void fit_lobes(benchmark::State& state) {
  std::mt19937_64 random(1);
  std::vector<problems::Problem> all;
  for (int i = 0; i < 1000; ++i)
    all.push_back(problems::lobes(random, static_cast<int>(state.range(0)), static_cast<int>(state.range(1))));
  double gap = 0;
  for (const auto& p : all) gap = std::max(gap, solve(p.m, p.b).optimality_gap);
  if (gap > 1e-9) state.SkipWithError("not optimal");
  std::vector<double> times_us;
  std::size_t i = 0;
  for (auto _ : state) {
    const auto before = std::chrono::steady_clock::now();
    benchmark::DoNotOptimize(solve(all[i % all.size()].m, all[i % all.size()].b));
    times_us.push_back(std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - before).count());
    ++i;
  }
  std::sort(times_us.begin(), times_us.end());
  state.counters["median_us"] = times_us[times_us.size() / 2];
  state.counters["p99.9_us"] = times_us[times_us.size() * 999 / 1000];
  state.counters["max_gap"] = gap;
}

BENCHMARK(fit_lobes<nnls>)->Args({5, 8})->Args({25, 9})->Args({1400, 12});
BENCHMARK(fit_lobes<l1_fit>)->Args({5, 8})->Args({25, 9})->Args({1400, 12});

}  // namespace
}  // namespace goniochrome::math
