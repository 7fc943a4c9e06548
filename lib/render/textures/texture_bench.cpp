// Frames of a textured sphere. Correctness first: a few pixels against the integral, beside the time.
#include <benchmark/benchmark.h>

#include <cmath>

#include "base/angles.h"
#include "base/testdata_for_test.h"
#include "image/surface_file.h"
#include "render/exact.h"
#include "render/picture_error.h"
#include "render/renderer.h"
#include "render/scenes_for_test.h"
#include "render/surface_layer.h"

namespace goniochrome::render {
namespace {

// Metal brushed in a direction that turns across: three lobes, exponents between those of the environment.
brdf::SbrdfTexture brushed(int size) {
  brdf::SbrdfTexture texture{size, size, 3, {}};
  for (int i = 0; i < size * size; ++i) {
    const double angle = 2 * kPi * (i % size) / size;
    for (const float value : {0.01F,
                              0.01F,
                              0.01F,
                              static_cast<float>(std::cos(angle)),
                              static_cast<float>(std::sin(angle)),
                              1.0F,
                              0.9F,
                              0.8F,
                              -1.0F,
                              0.0F,
                              1.0F,
                              18.0F,
                              2.0F,
                              1.9F,
                              1.8F,
                              -1.0F,
                              -0.8F,
                              1.0F,
                              56.0F,
                              3.0F,
                              2.9F,
                              2.8F,
                              -1.0F,
                              -1.0F,
                              1.0F,
                              184.0F})
      texture.values.push_back(value);
  }
  return texture;
}

// 1280 x 720, three lobes; arguments: whether the view moves, lights, whether the environment is there.
void BM_Texture(benchmark::State& state) {
  const bool view_moves = state.range(0) != 0;
  const mesh::Mesh mesh = sphere_mesh(160);
  envmap::PrefilteredEnvironment env = constant_env({1, 1, 1}, {4, 16, 64, 256});
  for (envmap::PrefilteredLobe& lobe : env.lobes) lobe.map = cube_of(128, [](const Vec3&) { return Vec3{1, 1, 1}; });
  const brdf::SbrdfTexture texture = brushed(128);
  Scene scene;
  scene.mesh = &mesh;
  scene.paints = {{}};
  if (state.range(2) != 0) scene.env = &env;
  for (int i = 0; i < state.range(1); ++i) scene.lights.push_back({normalized({1.0 * i, 1, 1}), {1, 1, 1}});
  const SurfaceLayer layer(scene, {{{{&texture, 4}}}}, brdf::CriticalAngle::kSlide);
  scene.layer = &layer;
  auto renderer = Renderer::create();
  if (!renderer.ok() || !renderer->load(scene, "cpu").ok()) return state.SkipWithError("no renderer");
  double azimuth_deg = 35;
  View view{Camera::orbit(mesh, azimuth_deg, 12, 0.6, 30, 16.0 / 9), 1280, 720, 1, true};
  Frame frame;
  if (!renderer->draw(view, frame).ok()) return state.SkipWithError("nothing drawn");
  image::Image white{256, 128, 3, std::vector<float>(std::size_t{256} * 128 * 3, 1.0F), {}};
  const auto source =
      envmap::Environment::from_lat_long(std::move(white), envmap::Environment::BadPixels::kError, "constant");
  const PictureError error = picture_error(frame, scene, scene.env != nullptr ? &*source : nullptr, 1, 20, 1);
  if (error.de00_mean > 0.5) return state.SkipWithError("far from the reference");
  view.with_centers = false;
  for (auto _ : state) {
    if (view_moves) azimuth_deg += 3;
    view.camera = Camera::orbit(mesh, azimuth_deg, 12, 0.6, 30, 16.0 / 9);
    if (!renderer->draw(view, frame).ok()) return state.SkipWithError("nothing drawn");
  }
  std::size_t seen = 0;
  for (std::size_t i = 3; i < frame.gbuffer->data.size(); i += 4) seen += frame.gbuffer->data[i] != 0;
  state.counters["de00_mean"] = error.de00_mean;
  state.counters["seen"] = static_cast<double>(seen);
}
BENCHMARK(BM_Texture)
    ->ArgsProduct({{0, 1}, {0}, {1}})
    ->Args({0, 1, 0})
    ->Args({0, 3, 0})
    ->Args({0, 1, 1})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

// The maps of testdata and, last, a paint of two lobes. A picture of 800 x 600 of a sphere
// that fills it as a teapot would; arguments: which of them, whether an environment or a lamp lights it, and whether
// the view moves. A map of two lobes is to take at most 1.5 times what the paint takes.
constexpr const char* kMaps[] = {"nameplate", "wood", "brushed"};
void BM_MapOrPaint(benchmark::State& state) {
  const auto which = static_cast<std::size_t>(state.range(0));
  const bool painted = which == std::size(kMaps);
  const mesh::Mesh mesh = sphere_mesh(160);
  const std::vector<double> exponents = {1.1, 4, 16, 64, 256};
  const envmap::PrefilteredEnvironment env = uneven_env(exponents, {16, 32, 64, 64, 64});
  brdf::SbrdfTexture texture;
  Scene scene;
  scene.mesh = &mesh;
  scene.paints = {{}};
  if (painted) {
    scene.paints[0].diffuse = {0.05, 0.04, 0.03};
    scene.paints[0].lobes = {{16, {0.1, 0.08, 0.05}, {0.02, 0.02, 0.02}}, {64, {0.2, 0.1, 0.1}, {0.1, 0.1, 0.1}}};
  } else {
    auto read = image::read_sbrdf(testdata(std::string(kMaps[which]) + ".sbrdf.exr"));
    if (!read.ok()) return state.SkipWithError(read.error().message.c_str());
    texture = *std::move(read);
  }
  if (state.range(1) != 0) {
    scene.env = &env;
  } else {
    scene.lights = {{normalized({0.3, 1, 1}), {1, 1, 1}}};
  }
  const SurfaceLayer layer(scene, {painted ? PartSurface{} : PartSurface{{{&texture, 1}}}},
                           brdf::CriticalAngle::kSlide);
  scene.layer = &layer;
  auto renderer = Renderer::create();
  if (!renderer.ok() || !renderer->load(scene, "cpu").ok()) return state.SkipWithError("no renderer");
  double azimuth_deg = 35;
  View view{Camera::orbit(mesh, azimuth_deg, 12, 0.7, 30, 4.0 / 3), 800, 600, 1, false};
  Frame frame;
  if (!renderer->draw(view, frame).ok()) return state.SkipWithError("nothing drawn");
  for (auto _ : state) {
    if (state.range(2) != 0) view.camera = Camera::orbit(mesh, azimuth_deg += 3, 12, 0.7, 30, 4.0 / 3);
    if (!renderer->draw(view, frame).ok()) return state.SkipWithError("nothing drawn");
  }
  std::size_t seen = 0;
  double sum = 0;  // of what is drawn, by which pictures before and after a change can be told apart
  for (std::size_t i = 3; i < frame.gbuffer->data.size(); i += 4) seen += frame.gbuffer->data[i] != 0;
  for (const float value : frame.picture.data) sum += value;
  state.counters["seen"] = static_cast<double>(seen);
  state.counters["sum"] = sum;
  state.SetLabel(painted ? "paint" : kMaps[which]);
}
BENCHMARK(BM_MapOrPaint)
    ->ArgsProduct({{0, 1, 2, 3}, {0, 1}, {0, 1}})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

}  // namespace
}  // namespace goniochrome::render
