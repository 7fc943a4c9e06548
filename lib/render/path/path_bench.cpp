// Error beside time: a vehicle under measured light, by paths that correct the open light, by paths alone, and by light
// that is gathered at few points. Folders of data: GONIOCHROME_DATA, else the speed shape under the project's own
// studio.
#include <benchmark/benchmark.h>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "base/angles.h"
#include "base/clock.h"
#include "base/parallel.h"
#include "base/testdata_for_test.h"
#include "prefilter/prefilter.h"
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
  envmap::PrefilteredEnvironment maps;
  Scene scene;
  std::optional<Transport> transport;
  VisibleSurface surface;
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

// `with_floor`: the ground of the environment under the mesh, and maps for the paint.
std::unique_ptr<BenchScene> bench_scene(const std::string& probe, int width, int height, bool with_floor = false) {
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
  if (with_floor) {
    prefilter::PrefilterRequest request;
    for (const paint::Lobe& lobe : silver().lobes)
      if (!lobe.is_mirror()) request.exponents.push_back(lobe.exponent);
    bench->maps =
        prefilter::prefiltered(*bench->environment, request, prefilter::prefilter_plan(*bench->environment, request),
                               [](const envmap::PrefilteredLobe&, double) {});
    bench->scene.env = &bench->maps, bench->scene.texels = &*bench->blocks;
    const mesh::Box box = bounding_box(bench->mesh);
    bench->scene.ground.emplace();
    bench->scene.ground->height = box.low.y;
    bench->scene.ground->probe_eye = {0.5 * (box.low.x + box.high.x), box.low.y + 1.2 * (box.high.y - box.low.y),
                                      0.5 * (box.low.z + box.high.z)};
    path.ground = bench->scene.ground;
  }
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

// Of the open light, point by point, as the engine `integral` sums it.
image::Image open_light(const BenchScene& bench) {
  const Gbuffer& g = bench.surface.gbuffer;
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

// The colors of some points of the mesh and of the floor by so many paths that little noise is left.
struct Truth {
  std::vector<std::size_t> numbers;  // among the points of a picture
  std::vector<PathEstimate> estimates;
};
Truth truth_of(const BenchScene& bench, const PathPicture& picture, const PathRequest& request, int count,
               int batches) {
  Truth truth;
  std::vector<std::size_t> kinds[2];
  for (std::size_t i = 0; i < picture.points.size(); ++i) kinds[picture.points[i].floor ? 1 : 0].push_back(i);
  for (const std::vector<std::size_t>& kind : kinds)
    for (std::size_t k = 0; k < static_cast<std::size_t>(count) && !kind.empty(); ++k)
      truth.numbers.push_back(kind[mixed(k, 5) % kind.size()]);
  truth.estimates.resize(truth.numbers.size());
  parallel_for(truth.numbers.size(), 1, [&](std::size_t begin, std::size_t) {
    const PathPoint& point = picture.points[truth.numbers[begin]];
    const rays::Spot spot = spot_at(bench.transport->rays(), bench.surface, point.x, point.y);
    truth.estimates[begin] = path_estimate(*bench.transport, request.options, spot,
                                           bench.surface.gbuffer.to_viewer(point.x, point.y), batches, 1000 + begin);
  });
  return truth;
}

// The 95th percentile of the differences to it, over the mesh or over the floor, whichever is larger, and the share of
// intervals of two standard deviations that cover it.
std::pair<double, double> error_of(const PathPicture& picture, const Truth& truth, double white) {
  std::vector<double> errors[2];
  double within = 0;
  for (std::size_t k = 0; k < truth.numbers.size(); ++k) {
    const PathPoint& point = picture.points[truth.numbers[k]];
    const PathEstimate& there = truth.estimates[k];
    const double difference = seen_difference(point.radiance, there.radiance, white);
    within += difference <= 2 * std::hypot(point.noise_de00, noise_de00(there.radiance, there.covariance, white));
    errors[point.floor ? 1 : 0].push_back(difference);
  }
  return {std::max(percentile_95(errors[0]), percentile_95(errors[1])),
          within / static_cast<double>(truth.numbers.size())};
}

// The whole picture with a floor. Arguments: the probe's number, whether light is gathered, bounces, hundredths of the
// tolerance, width. Processor time is that of the picture alone.
void BM_Picture(benchmark::State& state) {
  const auto paths = probes();
  const auto number = static_cast<std::size_t>(state.range(0));
  if (number >= paths.size()) return state.SkipWithError("no such probe");
  const int width = static_cast<int>(state.range(4));
  const auto bench = bench_scene(paths[number], width, width * 9 / 16, true);
  if (!bench) return state.SkipWithError("no scene");
  PathRequest request;
  request.options.bounces = static_cast<int>(state.range(2));
  request.tolerance_de00 = 0.01 * static_cast<double>(state.range(3));
  request.white_luminance = bench->white;
  request.gather = state.range(1) != 0;
  PathPicture picture;
  for (auto _ : state) {
    const OpenShading open(bench->scene);
    if (request.gather) request.open = &open;
    picture = path_picture(*bench->transport, bench->surface, nullptr, request);
  }
  const Truth truth = truth_of(*bench, picture, request, 200, 500);
  const auto [error, coverage] = error_of(picture, truth, bench->white);
  state.counters["error_p95_de00"] = error;
  state.counters["noise_p95_de00"] = picture.noise_p95_de00;
  state.counters["coverage"] = coverage;
  state.counters["samples"] = picture.samples_mean;
  state.SetLabel(std::filesystem::path(paths[number]).stem().string());
}
BENCHMARK(BM_Picture)
    ->ArgNames({"probe", "gather", "bounces", "tolerance", "width"})
    ->ArgsProduct({{0, 1, 2, 3}, {0, 1}, {0, 4}, {100, 50}, {320}})
    ->ArgsProduct({{0, 1, 2, 3}, {1}, {0, 4}, {100, 50}, {1280}})
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
