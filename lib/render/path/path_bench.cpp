// Error beside time: a vehicle under measured light, by paths that correct the open light, and by paths alone. Folders
// of data: GONIOCHROME_DATA, else the speed shape under the project's own studio.
#include <benchmark/benchmark.h>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "base/angles.h"
#include "base/clock.h"
#include "base/testdata_for_test.h"
#include "render/camera.h"
#include "render/exact.h"
#include "render/internal/seen.h"
#include "render/path/path_tracer.h"
#include "render/scenes_for_test.h"

namespace goniochrome::render {
namespace {

struct BenchScene {
  mesh::Mesh mesh;
  std::optional<envmap::Environment> environment;
  std::optional<envmap::BlockTree> blocks;
  Scene scene;
  std::optional<Transport> transport;
  Gbuffer surface;
  double white = 1;
};

// A silver of seven lobes: half of its light in flakes, a tenth diffuse, and a coat.
paint::LobeFit silver() {
  paint::LobeFit paint;
  paint.diffuse = 0.1 / kPi * color::Rgb{1, 1, 1};
  const double exponents[] = {1.3, 6, 20, 70, 250, 900}, shares[] = {0.1, 0.12, 0.12, 0.08, 0.04, 0};
  for (std::size_t j = 0; j < 6; ++j) {
    const double unit = (exponents[j] + 1) / (2 * kPi);
    paint.lobes.push_back(
        {exponents[j], shares[j] * unit * color::Rgb{1, 0.99, 0.97}, (j == 5 ? 0.02 : 0) * unit * color::Rgb{1, 1, 1}});
  }
  paint.lobes.push_back({paint::kMirrorExponent, {}, {0.5, 0.5, 0.5}});
  return paint;
}

std::vector<std::string> probes() {
  std::vector<std::string> paths;
  if (const char* data = std::getenv("GONIOCHROME_DATA")) {
    for (const auto& entry : std::filesystem::directory_iterator(std::string(data) + "/probes"))
      if (entry.path().extension() == ".hdr") paths.push_back(entry.path().string());
    std::ranges::sort(paths);
  }
  if (paths.empty()) paths.push_back(testdata("studio.exr"));
  return paths;
}

std::unique_ptr<BenchScene> bench_scene(const std::string& probe, int width, int height) {
  auto bench = std::make_unique<BenchScene>();
  const char* data = std::getenv("GONIOCHROME_DATA");
  auto mesh = mesh::read_mesh(data != nullptr ? std::string(data) + "/mesh/vehicle.obj" : testdata("speed-shape.obj"));
  auto environment = envmap::Environment::read(probe, envmap::Environment::BadPixels::kZero);
  if (!mesh.ok() || !environment.ok()) return nullptr;
  bench->mesh = *std::move(mesh);
  bench->environment.emplace(*std::move(environment));
  bench->blocks.emplace(*bench->environment);
  bench->scene.mesh = &bench->mesh;
  bench->scene.paints.assign(bench->mesh.parts.size(), silver());
  PathScene path;
  path.scene = &bench->scene;
  path.environment = &*bench->environment;
  auto transport = Transport::create(path);
  if (!transport.ok()) return nullptr;
  bench->transport.emplace(*std::move(transport));
  const Camera camera = Camera::orbit(bench->mesh, 35, 12, 1, 30, static_cast<double>(width) / height);
  bench->surface = visible_surface(bench->transport->rays(), *rays(camera, width, height), width, height);
  // The brightest that a white diffuser is here: what noise is seen before.
  const Vec3 flux = bench->environment->flux();
  bench->white = color::xyz_d65_from_rgb((1 / (2 * kPi)) * flux).Y;
  return bench;
}

// The unoccluded light, point by point, as the engine `integral` sums it.
image::Image open_light(const BenchScene& bench) {
  const Gbuffer& g = bench.surface;
  image::Image image{g.width, g.height, 4, std::vector<float>(static_cast<std::size_t>(g.width) * g.height * 4), {}};
  std::vector<SurfacePoint> points;
  std::vector<std::size_t> places;
  ExactModel model;
  model.fresnel = true;
  for (int y = 0; y < g.height; ++y) {
    for (int x = 0; x < g.width; ++x) {
      if (g.part(x, y) < 0) continue;
      points.push_back({g.normal(x, y), g.to_viewer(x, y), &bench.scene.paints[0], &model});
      places.push_back(static_cast<std::size_t>(y) * static_cast<std::size_t>(g.width) + static_cast<std::size_t>(x));
    }
  }
  const std::vector<color::Rgb> light = reference_radiance(points, Surroundings(*bench.blocks, 0.4), {});
  for (std::size_t i = 0; i < light.size(); ++i)
    for (int c = 0; c < 3; ++c)
      image.data[4 * places[i] + static_cast<std::size_t>(c)] = static_cast<float>(light[i][c]);
  return image;
}

// Arguments: the probe's number, correction or whole, bounces, hundredths of the tolerance.
void BM_Noise(benchmark::State& state) {
  const auto paths = probes();
  const auto number = static_cast<std::size_t>(state.range(0));
  if (number >= paths.size()) return state.SkipWithError("no such probe");
  const auto bench = bench_scene(paths[number], 1280, 720);
  if (!bench) return state.SkipWithError("no scene");
  const image::Image open = open_light(*bench);
  PathRequest request;
  request.options.correction = state.range(1) != 0;
  request.options.bounces = static_cast<int>(state.range(2));
  request.tolerance_de00 = 0.01 * static_cast<double>(state.range(3));
  request.time_limit_s = 60;
  request.white_luminance = bench->white;
  PathPicture picture;
  for (auto _ : state)
    picture = path_picture(*bench->transport, bench->surface, request.options.correction ? &open : nullptr, request);
  state.counters["noise_p95_de00"] = picture.noise_p95_de00;
  state.counters["noise_mean_de00"] = picture.noise_mean_de00;
  state.counters["samples"] = picture.samples_mean;
  state.counters["points"] = static_cast<double>(picture.points.size());
  state.SetLabel(std::filesystem::path(paths[number]).stem().string());
}
BENCHMARK(BM_Noise)
    ->ArgNames({"probe", "correction", "bounces", "tolerance"})
    ->ArgsProduct({{0, 1, 2, 3}, {1, 0}, {0, 4}, {100, 50}})
    ->Unit(benchmark::kSecond)
    ->Iterations(1)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

// The G-buffer by rays.
void BM_VisibleSurface(benchmark::State& state) {
  const auto bench = bench_scene(probes()[0], 64, 36);
  if (!bench) return state.SkipWithError("no scene");
  const Camera camera = Camera::orbit(bench->mesh, 35, 12, 1, 30, 16.0 / 9);
  const Rays rays = *render::rays(camera, 1280, 720);
  for (auto _ : state) benchmark::DoNotOptimize(visible_surface(bench->transport->rays(), rays, 1280, 720));
}
BENCHMARK(BM_VisibleSurface)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

}  // namespace
}  // namespace goniochrome::render
