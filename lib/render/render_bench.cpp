// Frames of a vehicle or of the speed shape, and the reference integrator. Correctness first: the difference of the two
// engines, or the closed form, beside the time.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdlib>
#include <string>

#include "base/angles.h"
#include "base/testdata_for_test.h"
#include "render/exact.h"
#include "render/internal/seen.h"
#include "render/left_out.h"
#include "render/planning.h"
#include "render/renderer.h"
#include "render/scene_effects.h"
#include "render/scenes_for_test.h"

namespace goniochrome::render {
namespace {

constexpr double kExponents[] = {1.3, 6, 20, 70, 250, 900, 3000};

struct BenchScene {
  mesh::Mesh mesh;
  envmap::PrefilteredEnvironment env;
  Scene scene;
};

// Every weight chosen so that a constant environment of 1 shows (1 + c)/2 per lobe.
std::unique_ptr<BenchScene> bench_scene(int lobes) {
  auto bench = std::make_unique<BenchScene>();
  const char* data = std::getenv("GONIOCHROME_DATA");  // the vehicle of 51k triangles, where there is one
  auto mesh = mesh::read_mesh(data != nullptr ? std::string(data) + "/mesh/vehicle.obj" : testdata("speed-shape.obj"));
  bench->mesh = mesh.ok() ? *std::move(mesh) : sphere_mesh();
  bench->env = constant_env({1, 1, 1}, {kExponents, kExponents + lobes});
  for (envmap::PrefilteredLobe& lobe : bench->env.lobes)
    lobe.map = cube_of(128, [](const Vec3&) { return Vec3{1, 1, 1}; });
  paint::LobeFit paint;
  for (int j = 0; j < lobes; ++j) {
    const double weight = (kExponents[j] + 1) / (4 * kPi);
    paint.lobes.push_back({kExponents[j], weight * color::Rgb{1, 1, 1}, weight * color::Rgb{1, 1, 1}});
  }
  bench->scene.mesh = &bench->mesh;
  bench->scene.env = &bench->env;
  bench->scene.paints.assign(bench->mesh.parts.size(), paint);
  return bench;
}

// The largest relative difference of any pixel between the two engines.
double disagreement(const BenchScene& bench, const View& view, OpenGlBy by = OpenGlBy::kSoftware) {
  Frame frames[2], *frame = frames;
  for (const char* engine : {"gl", "cpu"}) {
    auto renderer = Renderer::create(by);
    if (!renderer.ok() || !renderer->load(bench.scene, engine).ok()) return 1;
    if (!renderer->draw(view, *frame++).ok()) return 1;
  }
  double worst = 0;
  for (std::size_t i = 0; i < frames[0].picture.data.size(); ++i) {
    const double a = frames[0].picture.data[i], b = frames[1].picture.data[i];
    if (a != b) worst = std::max(worst, std::abs(a - b) / std::max(std::abs(a), 1e-3));
  }
  return worst;
}

View bench_view(const BenchScene& bench, double azimuth_deg, int samples) {
  return {Camera::orbit(bench.mesh, azimuth_deg, 12, 1, 30, 16.0 / 9), 1280, 720, samples, false};
}

void time_frames(benchmark::State& state, bool view_moves, OpenGlBy by = OpenGlBy::kSoftware) {
  const char* engine = state.range(0) == 0 ? "gl" : "cpu";
  const int lobes = static_cast<int>(state.range(1)), samples = static_cast<int>(state.range(2));
  auto renderer = Renderer::create(by);
  if (!renderer.ok()) return state.SkipWithError(("skipped: " + renderer.error().message).c_str());
  const auto bench = bench_scene(lobes);
  const double error = disagreement(*bench, bench_view(*bench, 35, samples), by);
  if (error > 1e-3) return state.SkipWithError("the engines disagree");
  if (!renderer->load(bench->scene, engine).ok()) return state.SkipWithError("nothing loaded");
  Frame frame;
  if (!renderer->draw(bench_view(*bench, 35, samples), frame).ok()) return state.SkipWithError("nothing drawn");
  double azimuth_deg = 35, gbuffer_ms = 0;
  for (auto _ : state) {
    if (view_moves) azimuth_deg += 3;
    for (paint::LobeFit& paint : bench->scene.paints) paint.diffuse.x += 1e-4;
    renderer->load_paints(bench->scene);
    if (!renderer->draw(bench_view(*bench, azimuth_deg, samples), frame).ok())
      return state.SkipWithError("nothing drawn");
    gbuffer_ms = std::max(gbuffer_ms, frame.gbuffer_ms);
  }
  std::size_t seen = 0;
  for (std::size_t i = 3; i < frame.gbuffer->data.size(); i += 4) seen += frame.gbuffer->data[i] != 0;
  state.counters["max_rel_error"] = error;
  state.counters["gbuffer_ms"] = gbuffer_ms;
  state.counters["seen"] = static_cast<double>(seen);
  state.counters["triangles"] = static_cast<double>(bench->mesh.triangles.size());
  state.counters["pictures_per_s"] = benchmark::Counter(1, benchmark::Counter::kIsIterationInvariantRate);
  state.SetLabel(fmt::format("{}, {}", engine, renderer->opengl()));
}

// 1280 x 720, diffuse, flake and gloss in every lobe, all effects; arguments: engine (0 gl, 1 cpu), lobes, samples.
// The paint is edited before every frame.
void BM_PaintEdited(benchmark::State& state) {
  time_frames(state, false);
}
void BM_ViewChanged(benchmark::State& state) {
  time_frames(state, true);
}
void frames(benchmark::internal::Benchmark* b) {
  for (const int engine : {0, 1}) {
    for (const int lobes : {1, 5, 7}) b->Args({engine, lobes, 1});
    b->Args({engine, 5, 4});
  }
  b->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
}
BENCHMARK(BM_PaintEdited)->Apply(frames);
BENCHMARK(BM_ViewChanged)->Apply(frames);

// Times on a GPU, where there is one: edits of the paint, and frames in which the view moves as well. The time of a
// picture includes reading it back.
void BM_GpuPaintEdited(benchmark::State& state) {
  time_frames(state, false, OpenGlBy::kGpu);
}
void BM_GpuViewChanged(benchmark::State& state) {
  time_frames(state, true, OpenGlBy::kGpu);
}
void gpu_frames(benchmark::internal::Benchmark* b) {
  for (const int lobes : {1, 5, 7})
    for (const int samples : {1, 4}) b->Args({0, lobes, samples});
  b->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
}
BENCHMARK(BM_GpuPaintEdited)->Apply(gpu_frames);
BENCHMARK(BM_GpuViewChanged)->Apply(gpu_frames);

// Brushed metal with 5 lobes in so many tilted normals, under light that changes fast; the truth has 400.
void BM_Tilts(benchmark::State& state) {
  auto bench = bench_scene(5);
  for (std::size_t i = 0; i < bench->env.lobes.size(); ++i) {
    const double k = 2.0 + 6.0 * static_cast<double>(i);
    bench->env.lobes[i].map = cube_of(128, [k](const Vec3& d) {
      return Vec3{1 + std::sin(k * d.x), 1 + std::cos(k * d.y), 1 + std::sin(k * d.z)};
    });
  }
  bench->scene.anisotropy.assign(bench->mesh.parts.size(), {0.04, 0.3});
  Effects effects = effects_of(bench->scene);
  effects.tilt_tolerance = 1e-9;
  const View view = bench_view(*bench, 35, 1);
  auto renderer = Renderer::create();
  Frame truth, frame;
  effects.most_tilts = 400;
  if (!renderer.ok() || !renderer->load(bench->scene, effects, "cpu").ok() || !renderer->draw(view, truth).ok())
    return state.SkipWithError("no renderer");
  effects.most_tilts = static_cast<int>(state.range(0));
  if (!renderer->load(bench->scene, effects, "cpu").ok()) return state.SkipWithError("not loaded");
  for (auto _ : state) {
    if (!renderer->draw(view, frame).ok()) return state.SkipWithError("nothing drawn");
  }
  std::vector<double> de00;
  for (int y = 0; y < view.height; ++y) {
    for (int x = 0; x < view.width; ++x) {
      if (frame.gbuffer->part(x, y) < 0) continue;
      const float *a = frame.picture.pixel(x, y), *b = truth.picture.pixel(x, y);
      de00.push_back(seen_difference({a[0], a[1], a[2]}, {b[0], b[1], b[2]}, 5));
    }
  }
  state.counters["de00_p95"] = percentile_95(std::move(de00));
}
BENCHMARK(BM_Tilts)
    ->Arg(5)
    ->Arg(9)
    ->Arg(31)
    ->Arg(81)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

// Colored light through the operator beside the component-wise product, frame by frame in turns; the least of each.
// Argument: engine.
void BM_Operator(benchmark::State& state) {
  const char* engine = state.range(0) == 0 ? "gl" : "cpu";
  const auto bench = bench_scene(5);
  bench->env.diffuse.map = cube_of(32, [](const Vec3& d) { return Vec3{1, 1 + 0.5 * d.x, 1 + 0.5 * d.y}; });
  const View view = bench_view(*bench, 35, 1);
  double least_ms[2] = {1e9, 1e9};
  std::vector<Renderer> renderers;
  for (const bool bilinear : {false, true}) {
    bench->scene.reflection = bilinear ? color::working_space_operator() : color::component_wise();
    if (disagreement(*bench, view) > 1e-3) return state.SkipWithError("the engines disagree");
    auto renderer = Renderer::create();
    if (!renderer.ok() || !renderer->load(bench->scene, engine).ok()) return state.SkipWithError("no renderer");
    renderers.push_back(*std::move(renderer));
  }
  Frame frame;
  for (auto _ : state) {
    for (std::size_t i = 0; i < 2; ++i) {
      if (!renderers[i].draw(view, frame).ok()) return state.SkipWithError("nothing drawn");
      least_ms[i] = std::min(least_ms[i], frame.frame_ms);
    }
  }
  state.counters["plain_ms"] = least_ms[0];
  state.counters["bilinear_ms"] = least_ms[1];
  state.counters["over_percent"] = 100 * (least_ms[1] / least_ms[0] - 1);
  state.SetLabel(engine);
}
BENCHMARK(BM_Operator)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond)->UseRealTime();

// Planning, all of it, beside a frame of what was planned. The picture must be within the tolerance of all effects.
void BM_Plan(benchmark::State& state) {
  const auto bench = bench_scene(5);
  const View view = bench_view(*bench, 35, 1);
  auto renderer = Renderer::create();
  if (!renderer.ok()) return state.SkipWithError("no renderer");
  const auto seen = renderer->look(bench->mesh, view);
  PlanRequest request;
  request.white_luminance = 5;
  double plan_ms = 1e9;
  Plan plan;
  for (auto _ : state) {
    auto made = renderer->load(bench->scene, {*seen}, request);
    if (!made.ok()) return state.SkipWithError("no plan");
    plan = *std::move(made);
    plan_ms = std::min(plan_ms, plan.time_ms);
  }
  const auto left = left_out(*renderer, seen_scene(bench->scene, {*seen}), plan, view, request.white_luminance);
  if (!left.ok() || left->de00_p95 > request.tolerance_de00) return state.SkipWithError("what is left out is seen");
  state.counters["plan_ms"] = plan_ms;
  state.counters["frame_ms"] = left->planned_ms;
  state.counters["frame_all_ms"] = left->full_ms;
  state.counters["de00_p95"] = left->de00_p95;
}
BENCHMARK(BM_Plan)->Unit(benchmark::kMillisecond)->UseRealTime();

// Points a second against an environment of 1024 x 512.
void BM_Reference(benchmark::State& state) {
  image::Image image{1024, 512, 3, std::vector<float>(1024 * 512 * 3, 1.0F), {}};
  const auto env =
      envmap::Environment::from_lat_long(std::move(image), envmap::Environment::BadPixels::kError, "constant");
  const auto bench = bench_scene(static_cast<int>(state.range(0)));
  const Vec3 n = normalized({1, 2, 3});
  const std::vector<SurfacePoint> points(64, {n, n, &bench->scene.paints.front()});
  double wanted = 0;
  for (int j = 0; j < state.range(0); ++j) wanted += 0.5 * (1 + (kExponents[j] + 1) / (kExponents[j] + 2));
  std::vector<color::Rgb> radiance;
  for (auto _ : state) radiance = reference_radiance(points, &*env, {});
  state.counters["rel_error"] = std::abs(radiance.front().x / wanted - 1);
  state.counters["points_per_s"] = benchmark::Counter(64, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(BM_Reference)->Arg(1)->Arg(7)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace goniochrome::render
