// What the effects of rays are worth, told from some points, against what they are worth in the whole picture.
#include "render/plan/ray_probe.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "base/clock.h"
#include "base/parallel.h"
#include "base/testdata_for_test.h"
#include "render/camera.h"
#include "render/exact.h"
#include "render/internal/seen.h"
#include "render/path/scenes_for_paths_for_test.h"
#include "render/plan/spread_pixels.h"

namespace goniochrome::render::ray_probe_test {
namespace {

constexpr RayEffects kAll{true, true, true}, kNoSelf{true, false, true}, kNoBounce{true, true, false};
constexpr int kBounces = 4;

paint::LobeFit silver() {
  paint::LobeFit paint = matt({0.2, 0.2, 0.19});
  paint.lobes = {{1.3, {0.05, 0.05, 0.05}, {}},
                 {20, {0.4, 0.4, 0.38}, {}},
                 {200, {0.8, 0.8, 0.8}, {0.5, 0.5, 0.5}},
                 {paint::kMirrorExponent, {}, {0.6, 0.6, 0.6}}};
  return paint;
}

// A ball with a dent that is 0.35 deep and as wide as its opening is.
mesh::Mesh dented_mesh() {
  mesh::Mesh mesh = sphere_mesh(48);
  const Vec3 toward = normalized({0.5, 0.4, 1});
  for (Vec3& p : mesh.positions) {
    const double angle = std::acos(std::clamp(dot(p, toward), -1.0, 1.0));
    p = (1 - 0.35 * std::exp(-angle * angle / 0.12)) * p;
  }
  mesh.normals.assign(mesh.positions.size(), Vec3{});
  for (const auto& t : mesh.triangles) {
    const Vec3 area = cross(mesh.positions[t[1]] - mesh.positions[t[0]], mesh.positions[t[2]] - mesh.positions[t[0]]);
    for (const std::uint32_t v : t) mesh.normals[v] += area;
  }
  for (Vec3& n : mesh.normals) n = length(n) > 0 ? normalized(n) : Vec3{0, 1, 0};
  return mesh;
}

// A closed box on a plate, with a ball before it.
mesh::Mesh box_on_a_plate() {
  mesh::Mesh mesh;
  add_rectangle(mesh, "plate", {-2, -1, -2}, {0, 0, 4}, {4, 0, 0});
  mesh::Mesh box = box_mesh(true);
  for (auto& t : box.triangles) std::swap(t[1], t[2]);  // facing outward
  for (Vec3& n : box.normals) n = -n;
  add_mesh(mesh, box, 0.6, {-0.4, -0.4, -0.3});
  add_mesh(mesh, sphere_mesh(24), 0.4, {0.6, -0.6, 0.7});
  return mesh;
}

struct NamedLight {
  const char* name;
  std::function<color::Rgb(int, int)> sky;  // of 32 x 16; none: dark
  std::vector<Light> lights;
};
std::vector<NamedLight> five_lights() {
  const auto lamp = [](int x, int y, int left, int top, int size) {
    return x >= left && x < left + size && y >= top && y < top + size;
  };
  return {{"even",
           [](int, int) {
             return color::Rgb{1, 1, 1};
           },
           {}},
          {"overcast",
           [](int, int y) {
             return (y < 8 ? 1.2 - 0.05 * y : 0.15) * color::Rgb{0.9, 1, 1.1};
           },
           {}},
          {"studio",
           [=](int x, int y) {
             const double light = lamp(x, y, 6, 3, 3) ? 12 : lamp(x, y, 20, 5, 2) ? 8 : 0.15;
             return light * color::Rgb{1, 0.95, 0.9};
           },
           {}},
          {"sun",
           [=](int x, int y) {
             return lamp(x, y, 11, 4, 1) ? color::Rgb{90, 85, 70} : color::Rgb{0.3, 0.4, 0.6};
           },
           {}},
          {"lamps", nullptr, {{normalized({1, 2, 1}), {0.8, 0.8, 0.8}}, {normalized({-1, 0.5, 1}), {0.3, 0.25, 0.2}}}}};
}

struct Seen {
  std::vector<RayPoint> points;
  std::vector<color::Rgb> base;
  std::vector<Vec3> to_viewer;
};

// All visible points of a small picture.
Seen seen_of(const PathStage& stage, const Camera& camera, int width, int height) {
  Seen seen;
  const VisibleSurface surface = visible_surface(stage.transport->rays(), *rays(camera, width, height), width, height);
  const auto gbuffer = std::make_shared<const Gbuffer>(surface.gbuffer);
  std::vector<SurfacePoint> exact;
  ExactModel model;
  model.fresnel = true;
  for (const auto& [g, x, y] : spread_pixels({gbuffer}, gbuffer->data.size())) {
    seen.points.push_back({spot_at(stage.transport->rays(), surface, x, y), rays::float3(g->to_viewer(x, y))});
    seen.to_viewer.push_back(g->to_viewer(x, y));
    exact.push_back(
        {g->normal(x, y), g->to_viewer(x, y), &stage.scene.paints[static_cast<std::size_t>(g->part(x, y))], &model});
  }
  seen.base = reference_radiance(exact, stage.environment ? &*stage.environment : nullptr, stage.scene.lights);
  return seen;
}

// The same three figures by many samples at every point, each effect traced by itself. Two halves tell how much of a
// squared difference is noise: it is twice as much in either as in their mean.
std::array<double, 3> true_worth(const PathStage& stage, const Seen& seen, double white, int batches) {
  std::array<std::array<std::vector<color::Rgb>, 2>, 3> added;  // all, without self, without bounce; halves
  const RayEffects kinds[] = {kAll, kNoSelf, kNoBounce};
  for (std::size_t kind = 0; kind < 3; ++kind) {
    PathOptions options;
    options.bounces = kBounces;
    options.correction = true;
    options.into_lobes = kinds[kind].self, options.into_diffuse = kinds[kind].bounce;
    for (std::size_t half = 0; half < 2; ++half) {
      added[kind][half].resize(seen.points.size());
      parallel_for(seen.points.size(), 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
          added[kind][half][i] = path_estimate(*stage.transport, options, seen.points[i].spot, seen.to_viewer[i],
                                               batches / 2, mixed(77 + half, i))
                                     .radiance;
      });
    }
  }
  std::array<double, 3> worth{};
  for (std::size_t kind = 0; kind < 3; ++kind) {
    std::vector<double> de00;
    for (std::size_t i = 0; i < seen.points.size(); ++i) {
      const auto squared = [&](const color::Rgb& all, const color::Rgb& some) {
        const double d = seen_difference(seen.base[i] + all, seen.base[i] + (kind == 0 ? color::Rgb{} : some), white);
        return d * d;
      };
      const auto& [all, some] = std::tie(added[0], added[kind]);
      const double whole = squared(0.5 * (all[0][i] + all[1][i]), 0.5 * (some[0][i] + some[1][i]));
      const double halves = 0.5 * (squared(all[0][i], some[0][i]) + squared(all[1][i], some[1][i]));
      de00.push_back(std::sqrt(std::max(0.0, 2 * whole - halves)));
    }
    worth[kind] = percentile_95(std::move(de00));
  }
  return worth;
}

struct Shape {
  std::string name;
  mesh::Mesh mesh;
};

ProbeSetting setting_of(const PathStage& stage, const Seen& seen) {
  ProbeSetting setting;
  setting.transport = &*stage.transport;
  setting.bounces = kBounces;
  setting.visible_points = static_cast<double>(seen.points.size());
  return setting;
}

// Points that are spread over the picture tell what holds for all of it: within a factor of 1.3, or 0.1 dE00. The truth
// takes 4,096 samples at every point: with a quarter of them its own noise moves a percentile by 0.05.
void expect_predicted(const Shape& shape) {
  const int width = 80, height = 60;
  for (const NamedLight& light : five_lights()) {
    PathStage stage(shape.mesh, {silver()});
    if (light.sky) stage.environment = environment_of(32, 16, light.sky);
    stage.scene.lights = light.lights;
    stage.build();
    const Camera camera = Camera::orbit(stage.mesh, 35, 25, 1, 30, static_cast<double>(width) / height);
    const Seen all = seen_of(stage, camera, width, height);
    const Stopwatch clock;
    const RayProbe probe = RayProbe::traced(setting_of(stage, all), all.points, all.base);
    const double ms = 1000 * clock.elapsed_s();
    const std::array<double, 3> truth = true_worth(stage, all, 1, 256);
    const RayEffects without[] = {{}, kNoSelf, kNoBounce};
    const char* names[] = {"shadow", "self", "bounce"};
    for (std::size_t k = 0; k < 3; ++k) {
      const Worth worth = probe.worth(kAll, without[k]);
      const std::string which = shape.name + ", " + light.name + ", " + names[k];
      ::testing::Test::RecordProperty(
          which, fmt::format("{:.3f} +- {:.3f}, truth {:.3f}; {} points, {} samples, {:.0f} ms", worth.de00_p95,
                             worth.standard_error, truth[k], probe.size(), probe.samples(), ms));
      if (std::abs(worth.de00_p95 - truth[k]) <= 0.1) continue;
      EXPECT_LE(worth.de00_p95, 1.3 * truth[k]) << which << " +- " << worth.standard_error;
      EXPECT_GE(worth.de00_p95, truth[k] / 1.3) << which << " +- " << worth.standard_error;
    }
  }
}

TEST(RayProbe, PredictsTheWorthOfADent) {
  expect_predicted({"dented ball", dented_mesh()});
}

TEST(RayProbe, PredictsTheWorthOfABoxOnAPlate) {
  expect_predicted({"box on a plate", box_on_a_plate()});
}

TEST(RayProbe, PredictsTheWorthOfTheSpeedShape) {
  auto mesh = mesh::read_mesh(testdata("speed-shape.obj"));
  ASSERT_TRUE(mesh.ok());
  expect_predicted({"speed shape", *std::move(mesh)});
}

TEST(RayProbe, PredictsTheWorthOfMeshesRealData) {
  const char* data = std::getenv("GONIOCHROME_DATA");
  if (data == nullptr) GTEST_SKIP() << "GONIOCHROME_DATA is not set";
  for (const char* name : {"teapot", "vehicle"}) {
    auto mesh = mesh::read_mesh(std::string(data) + "/mesh/" + name + ".obj");
    ASSERT_TRUE(mesh.ok());
    expect_predicted({name, *std::move(mesh)});
  }
}

// The same of the floor, by many samples with it and without it.
double true_floor(const PathStage& stage, const Transport& over_floor, const Seen& seen) {
  PathOptions options;
  options.bounces = kBounces;
  options.correction = true;
  std::vector<double> de00(seen.points.size());
  parallel_for(de00.size(), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto with = path_estimate(over_floor, options, seen.points[i].spot, seen.to_viewer[i], 256, mixed(5, i)),
                 without =
                     path_estimate(*stage.transport, options, seen.points[i].spot, seen.to_viewer[i], 256, mixed(6, i));
      de00[i] = seen_difference(seen.base[i] + with.radiance, seen.base[i] + without.radiance, 1);
    }
  });
  return percentile_95(std::move(de00));
}

TEST(RayProbe, PredictsTheWorthOfAFloor) {
  for (const bool dented : {false, true}) {
    for (const std::size_t light : {std::size_t{1}, std::size_t{3}}) {
      PathStage stage(dented ? dented_mesh() : sphere_mesh(48), {silver()});
      stage.environment = environment_of(32, 16, five_lights()[light].sky);
      stage.build();
      const Seen all = seen_of(stage, Camera::orbit(stage.mesh, 35, 25, 1, 30, 1), 32, 32);
      PathScene over;
      over.scene = &stage.scene, over.environment = &*stage.environment;
      over.ground.emplace();
      over.ground->height = -1, over.ground->probe_eye = {0, -0.3, 0};
      over.rays = std::make_shared<const rays::RayScene>(stage.transport->rays().over({-1}));
      const auto over_floor = Transport::create(over);
      ASSERT_TRUE(over_floor.ok());
      ProbeSetting setting = setting_of(stage, all);
      setting.transport = &*over_floor, setting.without_floor = &*stage.transport;
      const RayProbe probe = RayProbe::traced(setting, all.points, all.base);
      ASSERT_TRUE(probe.floor_worth().has_value());
      const double predicted = probe.floor_worth()->de00_p95, truth = true_floor(stage, *over_floor, all);
      ::testing::Test::RecordProperty(
          fmt::format("{}, {}", dented ? "dented ball" : "ball", five_lights()[light].name),
          fmt::format("{:.3f} +- {:.3f}, truth {:.3f}", predicted, probe.floor_worth()->standard_error, truth));
      EXPECT_GT(truth, 0.3) << "it matters here";
      EXPECT_TRUE(std::abs(predicted - truth) <= 0.1 || (predicted <= 1.3 * truth && predicted >= truth / 1.3))
          << predicted << " +- " << probe.floor_worth()->standard_error << ", truth " << truth;
      // The control: without a floor to be priced nothing is said of it, and a ball is worth nothing.
      const RayProbe bare = RayProbe::traced(setting_of(stage, all), all.points, all.base);
      EXPECT_FALSE(bare.floor_worth().has_value());
      EXPECT_EQ(bare.free(), !dented);
    }
  }
}

// No ray that leaves a ball meets it again: nothing, not little. The control has a dent.
TEST(RayProbe, ABallIsWorthExactlyNothing) {
  for (const bool dented : {false, true}) {
    for (const NamedLight& light : five_lights()) {
      PathStage stage(dented ? dented_mesh() : sphere_mesh(48), {silver()});
      if (light.sky) stage.environment = environment_of(32, 16, light.sky);
      stage.scene.lights = light.lights;
      stage.build();
      const Seen all = seen_of(stage, Camera::orbit(stage.mesh, 35, 25, 1, 30, 1), 40, 40);
      const RayProbe probe = RayProbe::traced(setting_of(stage, all), all.points, all.base);
      EXPECT_EQ(probe.free(), !dented);
      for (const RayEffects& without : {RayEffects{}, kNoSelf, kNoBounce})
        EXPECT_EQ(probe.worth(kAll, without).de00_p95 == 0, !dented) << light.name;
      EXPECT_EQ(probe.worth(kAll, kAll).de00_p95, 0);
    }
  }
}

TEST(RayProbe, IsTheSameForAnyNumberOfThreads) {
  PathStage stage(dented_mesh(), {silver()});
  stage.environment = environment_of(32, 16, five_lights()[3].sky);
  stage.build();
  const Seen all = seen_of(stage, Camera::orbit(stage.mesh, 35, 25, 1, 30, 1), 32, 32);
  std::vector<double> worth;
  for (const int count : {1, 2, 5}) {
    set_threads(count);
    worth.push_back(RayProbe::traced(setting_of(stage, all), all.points, all.base).worth(kAll, {}).de00_p95);
  }
  set_threads(0);
  EXPECT_EQ(worth[0], worth[1]);
  EXPECT_EQ(worth[0], worth[2]);
}

}  // namespace
}  // namespace goniochrome::render::ray_probe_test
