// A picture of the speed shape, and the reference integrator. Correctness first: the furnace's closed form beside the
// time.
#include <benchmark/benchmark.h>

#include <algorithm>

#include "render/reference.h"
#include "render/renderer.h"
#include "render/scenes_for_test.h"

namespace goniochrome {
namespace {

constexpr double kExponents[] = {1.3, 6, 20, 70, 250, 900, 3000};

struct BenchScene {
  Mesh mesh;
  PrefilteredEnvironment env;
  Scene scene;
};

// Every weight chosen so that a constant environment of 1 shows (1 + c)/2 per lobe.
std::unique_ptr<BenchScene> bench_scene(int lobes) {
  auto bench = std::make_unique<BenchScene>();
  auto mesh = read_mesh(GONIOCHROME_TESTDATA "/speed-shape.obj");
  bench->mesh = mesh.ok() ? *std::move(mesh) : sphere_mesh();
  bench->env = constant_env({1, 1, 1}, {kExponents, kExponents + lobes});
  for (PrefilteredLobe& lobe : bench->env.lobes) lobe.map = cube_of(128, [](const Vec3&) { return Vec3{1, 1, 1}; });
  LobeFit paint;
  for (int j = 0; j < lobes; ++j) {
    const double weight = (kExponents[j] + 1) / (4 * std::numbers::pi);
    paint.lobes.push_back({kExponents[j], weight * Rgb{1, 1, 1}, weight * Rgb{1, 1, 1}});
  }
  bench->scene.mesh = &bench->mesh;
  bench->scene.env = &bench->env;
  bench->scene.paints.assign(bench->mesh.parts.size(), paint);
  return bench;
}

double furnace_error(const Frame& frame, int lobes) {
  double worst = 0;
  for (int y = 0; y < frame.gbuffer.height; ++y) {
    for (int x = 0; x < frame.gbuffer.width; ++x) {
      if (frame.gbuffer.part(x, y) < 0) continue;
      const double wanted = lobes * (1 + dot(frame.gbuffer.normal(x, y), frame.gbuffer.to_viewer(x, y))) / 2;
      worst = std::max(worst, std::abs(frame.centers.pixel(x, y)[0] / wanted - 1));
    }
  }
  return worst;
}

// 1280 x 720; arguments: lobes, samples.
void BM_Frame(benchmark::State& state) {
  const int lobes = static_cast<int>(state.range(0)), samples = static_cast<int>(state.range(1));
  const auto bench = bench_scene(lobes);
  auto renderer = Renderer::create();
  if (!renderer.ok() || !renderer->load(bench->scene).ok()) return state.SkipWithError("no renderer");
  const Camera camera = Camera::orbit(bench->mesh, 35, 12, 1, 30, 16.0 / 9);
  const auto checked = renderer->draw(camera, 1280, 720, 1, true);
  const double error = furnace_error(*checked, lobes);
  if (error > 1e-4) return state.SkipWithError("the furnace does not hold");
  double gbuffer_ms = 0;
  for (auto _ : state) gbuffer_ms = renderer->draw(camera, 1280, 720, samples)->gbuffer_ms;
  state.counters["max_rel_error"] = error;
  state.counters["gbuffer_ms"] = gbuffer_ms;
  state.counters["triangles"] = static_cast<double>(bench->mesh.triangles.size());
}
BENCHMARK(BM_Frame)
    ->Args({1, 1})
    ->Args({5, 1})
    ->Args({7, 1})
    ->Args({5, 4})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

// Points a second against an environment of 1024 x 512.
void BM_Reference(benchmark::State& state) {
  Image image{1024, 512, 3, std::vector<float>(1024 * 512 * 3, 1.0F), {}};
  const auto env = Environment::from_lat_long(std::move(image), Environment::BadPixels::kError, "constant");
  const auto bench = bench_scene(static_cast<int>(state.range(0)));
  const Vec3 n = normalized({1, 2, 3});
  const std::vector<SurfacePoint> points(64, {n, n, &bench->scene.paints.front()});
  double wanted = 0;
  for (int j = 0; j < state.range(0); ++j) wanted += 0.5 * (1 + (kExponents[j] + 1) / (kExponents[j] + 2));
  std::vector<Rgb> radiance;
  for (auto _ : state) radiance = reference_radiance(points, &*env, {});
  state.counters["rel_error"] = std::abs(radiance.front().x / wanted - 1);
  state.counters["points_per_s"] = benchmark::Counter(64, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(BM_Reference)->Arg(1)->Arg(7)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace goniochrome

BENCHMARK_MAIN();
