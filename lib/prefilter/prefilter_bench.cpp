// Times of prefiltering, each with its error, against the project's own vectorised sum over all pairs of texels.
// GONIOCHROME_PROBE names the environment in place of a drawn sky.
#include "base/angles.h"
#include "prefilter/prefilter.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <map>
#include <random>

#include "prefilter/exact_lobe.h"
#include "prefilter/internal/all_pairs_bench.h"
#include "prefilter/internal/mirror.h"

namespace goniochrome::prefilter {
namespace {

const std::vector<double> kExponents = {6, 20, 70, 250, 900, 3000};  // and 1, the diffuse lobe
constexpr int kStride = 61;  // of the texels that the sum over all pairs does: its cost is the same for every texel

// A sky, a dark ground, noise, and a sun of 8e4 over two texels.
envmap::Environment sky(int height) {
  image::Image image = {2 * height, height, 3, std::vector<float>(static_cast<std::size_t>(height) * height * 6), {}};
  const envmap::SphereGrid grid(envmap::SphereGrid::Layout::kLatLong, 2 * height, height);
  std::mt19937 random(4);
  std::uniform_real_distribution<float> unit(0.5F, 1.5F);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < 2 * height; ++x) {
      const double up = grid.direction(x, y).y;
      const float v = unit(random) * static_cast<float>(up > 0 ? 1 + up : 0.05);
      const bool sun = y == height / 3 && (x == height / 2 || x == height / 2 + 1);
      const float rgb[] = {sun ? 8e4F : 0.6F * v, sun ? 7e4F : 0.8F * v, sun ? 5e4F : v};
      std::copy(rgb, rgb + 3, image.pixel(x, y));
    }
  return envmap::Environment::from_lat_long(std::move(image), envmap::Environment::BadPixels::kError, "sky").value();
}

const envmap::Environment& environment(int height) {
  static std::map<int, envmap::Environment> all;
  const auto found = all.find(height);
  if (found != all.end()) return found->second;
  const char* probe = height == 512 ? std::getenv("GONIOCHROME_PROBE") : nullptr;
  if (!probe) return all.emplace(height, sky(height)).first->second;
  auto read = envmap::Environment::read(probe, envmap::Environment::BadPixels::kError);
  if (!read.ok()) {
    std::fprintf(stderr, "%s\n", read.error().message.c_str());
    std::exit(3);
  }
  return all.emplace(height, std::move(read).value()).first->second;
}

// The largest error at some of the directions, relative as the tolerance.
double largest_error_of_sums(const envmap::Environment& env, const std::vector<Vec3>& directions,
                             const std::vector<float>& values) {
  const Vec3 mean = (1 / (4 * kPi)) * env.flux();
  const std::size_t lobes = AllPairs::kExponents.size();
  double worst = 0;
  for (std::size_t i = 0; i < directions.size(); i += std::max<std::size_t>(1, directions.size() / 20))
    for (std::size_t k = 0; k < lobes; ++k) {
      const Vec3 want = reference_lobe(env, directions[i], AllPairs::kExponents[k]);
      for (int c = 0; c < 3; ++c) {
        const double got = values[3 * (i * lobes + k) + static_cast<std::size_t>(c)];
        worst = std::max(worst, std::fabs(got - want[c]) / std::max(want[c], 1e-3 * mean[c]));
      }
    }
  return worst;
}

// Processor seconds of all threads: other work on the machine lengthens the wall time of a run, and of its two halves
// unevenly.
class ProcessorClock {
 public:
  double elapsed_s() const { return static_cast<double>(std::clock() - start_) / CLOCKS_PER_SEC; }

 private:
  std::clock_t start_ = std::clock();
};

// Seconds of a whole size by all pairs, from every kStride-th texel; and its largest error.
struct AllPairsCost {
  double time_s = 0, max_error = 0;
};
AllPairsCost all_pairs_cost(const envmap::Environment& env, int size, bool with_error) {
  const envmap::SphereGrid grid = envmap::map_grid(envmap::SphereGrid::Layout::kCube, size);
  std::vector<Vec3> directions;
  const int texels = 6 * size * size, stride = std::max(1, kStride * size / 128 * size / 128);
  for (int i = 0; i < texels; i += stride) directions.push_back(grid.direction(i % size, i / size));
  const AllPairs sum(env);
  const ProcessorClock clock;
  const std::vector<float> values = sum.lobes(directions);
  AllPairsCost cost;
  cost.time_s = clock.elapsed_s() * texels / static_cast<double>(directions.size());
  if (with_error) cost.max_error = largest_error_of_sums(env, directions, values);
  return cost;
}

double largest_error(const envmap::Environment& env, const envmap::PrefilteredEnvironment& result) {
  double worst = lobe_error(env, result.diffuse, 20, 5, 1).max;
  for (const envmap::PrefilteredLobe& lobe : result.lobes) worst = std::max(worst, lobe_error(env, lobe, 20, 5, 1).max);
  return worst;
}

// Seven lobes and the mirror, the file included. Arguments: rows of the map, size (0: each lobe's own), tolerance as
// the negative power of ten.
void BM_Prefilter(benchmark::State& state) {
  const envmap::Environment& env = environment(static_cast<int>(state.range(0)));
  const PrefilterRequest request = {kExponents, true, static_cast<int>(state.range(1)),
                                    std::pow(10, -static_cast<double>(state.range(2)))};
  const std::string file = (std::filesystem::temp_directory_path() / "prefilter_bench.env.exr").string();
  envmap::PrefilteredEnvironment result;
  const ProcessorClock clock;
  for (auto _ : state) {
    result = prefiltered(env, request, prefilter_plan(env, request), [](const envmap::PrefilteredLobe&, double) {});
    if (!envmap::write_env(file, result, "benchmark").ok()) state.SkipWithError("the file cannot be written");
  }
  state.counters["processor_s"] = clock.elapsed_s() / static_cast<double>(state.iterations());
  std::filesystem::remove(file);
  state.counters["max_error"] = largest_error(env, result);
}
BENCHMARK(BM_Prefilter)
    ->ArgNames({"rows", "size", "digits"})
    ->ArgsProduct({{512}, {128, 256}, {4}})
    ->Args({512, 0, 3})
    ->Args({2048, 128, 3})
    ->ArgsProduct({{256, 1024}, {128}, {4}})
    ->ArgsProduct({{512}, {32, 64, 512}, {4}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

// Both within one run: how many times faster than the sum over all pairs, and the errors of both.
void BM_AgainstAllPairs(benchmark::State& state) {
  const int size = static_cast<int>(state.range(0));
  const envmap::Environment& env = environment(512);
  const PrefilterRequest request = {kExponents, false, size, 1e-4};
  double ours_s = 0, theirs_s = 0, theirs_error = 0;
  envmap::PrefilteredEnvironment result;
  for (auto _ : state) {
    const ProcessorClock clock;
    result = prefiltered(env, request, prefilter_plan(env, request), [](const envmap::PrefilteredLobe&, double) {});
    ours_s += clock.elapsed_s();
    const AllPairsCost cost = all_pairs_cost(env, size, theirs_error == 0);
    theirs_s += cost.time_s;
    theirs_error = std::max(theirs_error, cost.max_error);
  }
  state.counters["ours_processor_s"] = ours_s / static_cast<double>(state.iterations());
  state.counters["all_pairs_processor_s"] = theirs_s / static_cast<double>(state.iterations());
  state.counters["times_faster"] = theirs_s / ours_s;
  state.counters["max_error"] = largest_error(env, result);
  state.counters["all_pairs_max_error"] = theirs_error;
}
BENCHMARK(BM_AgainstAllPairs)
    ->ArgName("size")
    ->Arg(128)
    ->Arg(256)
    ->Iterations(3)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

// The naive mip chain: the map averaged over the texels of a cube of N, then summed over all pairs.
void BM_BoxMip(benchmark::State& state) {
  const int source = static_cast<int>(state.range(0)), size = static_cast<int>(state.range(1));
  const envmap::Environment& env = environment(512);
  double total_s = 0;
  const envmap::SphereGrid grid = envmap::map_grid(envmap::SphereGrid::Layout::kCube, size);
  std::vector<Vec3> directions;
  for (int i = 0; i < 6 * size * size; i += kStride) directions.push_back(grid.direction(i % size, i / size));
  std::vector<float> values;
  for (auto _ : state) {
    const ProcessorClock box_clock;
    envmap::CubeMap map(source);
    map.texels = mirror_values(env, envmap::map_grid(envmap::SphereGrid::Layout::kCube, source), {});
    const double box_s = box_clock.elapsed_s();
    const AllPairs sum(envmap::Environment::from_cube(map, "box"));
    const ProcessorClock clock;
    values = sum.lobes(directions);
    total_s += box_s + clock.elapsed_s() * 6.0 * size * size / static_cast<double>(directions.size());
  }
  state.counters["processor_s"] = total_s / static_cast<double>(state.iterations());
  state.counters["max_error"] = largest_error_of_sums(env, directions, values);
}
BENCHMARK(BM_BoxMip)
    ->ArgNames({"source", "size"})
    ->ArgsProduct({{8, 16, 32, 64, 128}, {128}})
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace goniochrome::prefilter
