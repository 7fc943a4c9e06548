// The price of the engine path, told from some pixels, against what it takes for all of them.
#include "render/plan/path_price.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/parallel.h"
#include "envmap/bright_spots.h"
#include "render/path/scenes_for_paths_for_test.h"
#include "render/path/visible_white.h"
#include "render/plan/floor_probe.h"
#include "render/spots.h"

namespace goniochrome::render::path_price_test {
namespace {

constexpr int kWidth = 60, kHeight = 40, kBounces = 4;

paint::LobeFit silver() {
  paint::LobeFit paint = matt({0.042, 0.044, 0.046});
  paint.lobes = {{1.3, {0.067, 0.069, 0.070}, {}},
                 {6, {0.345, 0.347, 0.345}, {}},
                 {20, {0.36, 0.36, 0.36}, {}},
                 {900, {}, {1.57, 1.57, 1.57}}};
  return paint;
}

// An open box with a ball in it.
mesh::Mesh ball_in_a_box() {
  mesh::Mesh mesh = box_mesh(false);
  add_mesh(mesh, sphere_mesh(16), 0.5, {0.1, -0.5, 0});
  return mesh;
}

// A sunlit field, an overcast one, and a dark studio with two lamps.
envmap::Environment field() {
  return environment_of(256, 128, [](int x, int y) {
    if (x == 90 && y == 30) return color::Rgb{4000, 3800, 3200};
    return (y < 64 ? 0.5 + 0.005 * y : 0.12 + 0.05 * ((x / 16) % 2)) * color::Rgb{0.8, 0.9, 1.1};
  });
}
envmap::Environment overcast() {
  return environment_of(64, 32, [](int x, int y) {
    return (y < 16 ? 1.2 - 0.03 * y : 0.12 + 0.05 * ((x / 4) % 2)) * color::Rgb{0.9, 1, 1.1};
  });
}
envmap::Environment dark_studio() {
  return environment_of(64, 32, [](int x, int y) {
    const auto lamp = [&](int left, int top, int size) {
      return x >= left && x < left + size && y >= top && y < top + size;
    };
    return (lamp(12, 6, 6) ? 20.0 : lamp(40, 9, 3) ? 30.0 : 0.06) * color::Rgb{1, 0.95, 0.9};
  });
}

struct Picture {
  Picture(mesh::Mesh mesh, envmap::Environment environment) : stage(std::move(mesh), {silver()}) {
    stage.environment = std::move(environment);
    const mesh::Box box = bounding_box(stage.mesh);
    stage.ground.emplace();
    stage.ground->height = box.low.y, stage.ground->probe_eye = {0, box.low.y + 1, 0};
    stage.build();
    const Camera camera = Camera::orbit(stage.mesh, 35, 25, 1, 30, static_cast<double>(kWidth) / kHeight);
    gbuffer = std::make_shared<Gbuffer>(seen_by_rays(stage.mesh, camera, kWidth, kHeight));
    surface = visible_surface(stage.transport->rays(), Rays(gbuffer->rays), kWidth, kHeight);
    white = visible_white(*stage.transport, surface, kBounces, 1);
  }

  // Of all pixels together.
  double drawn_samples(double tolerance_de00, int pixel_samples) const {
    PathRequest request;
    request.options.bounces = kBounces;
    request.tolerance_de00 = tolerance_de00, request.pixel_samples = pixel_samples;
    request.white_luminance = white;
    const PathPicture picture = path_picture(*stage.transport, surface, nullptr, request);
    EXPECT_TRUE(picture.reached);
    return picture.samples_mean * static_cast<double>(picture.points.size());
  }

  // As a plan has it: what the rasterizer draws, and the floor beside it.
  PathWork work(double tolerance_de00, int pixel_samples, bool with_floor) const {
    PathWork work;
    work.mesh = probe_pixels({gbuffer}, 32);
    for (std::size_t i = 3; i < gbuffer->data.size(); i += 4) work.mesh_pixels += gbuffer->data[i] != 0 ? 1 : 0;
    if (with_floor) {
      const FloorPixels floor = floor_pixels(*stage.transport, stage.scene, nullptr, {gbuffer}, 32);
      for (const FloorPoint& point : floor.points) work.floor.push_back(point.pixel);
      work.floor_pixels = floor.count;
    }
    work.pixel_samples = pixel_samples;
    work.white_luminance = white, work.tolerance_de00 = tolerance_de00, work.bounces = kBounces;
    return work;
  }

  PathStage stage;
  std::shared_ptr<Gbuffer> gbuffer;
  VisibleSurface surface;
  double white = 1;
};

double told_samples(const Transport& transport, const PathWork& work) {
  return path_price(transport, work).samples * (work.mesh_pixels + work.floor_pixels);
}

struct Case {
  const char* name;
  mesh::Mesh (*mesh)();
  envmap::Environment (*light)();
  double tolerance_de00;
  int pixel_samples;
  // Told over drawn samples. In the field most pixels need fewer than the engine draws of each: were they taken for
  // noisy by what they lack of that, it would be 1.28 to 1.43.
  double most = 2;
};

// The control has what other engines draw: the mesh alone, and a sun that is a lamp.
TEST(PathPrice, ToldSamplesAreWithinAFactorOfTwo) {
  const auto ball = [] { return sphere_mesh(24); };
  const Case cases[] = {{"ball, field", ball, field, 1, 1, 1.25},
                        {"ball, studio", ball, dark_studio, 1, 1},
                        {"box, field", ball_in_a_box, field, 2, 1, 1.25},
                        {"box, overcast", ball_in_a_box, overcast, 0.5, 1},
                        {"ball, overcast, coarse", ball, overcast, 3, 1},
                        {"ball, field, coarse", ball, field, 3, 1, 1.25},
                        {"box, studio", ball_in_a_box, dark_studio, 1, 1},
                        {"box, studio, four samples a pixel", ball_in_a_box, dark_studio, 2, 4}};
  double worst_control = 1;
  for (const Case& of : cases) {
    const Picture picture(of.mesh(), of.light());
    const double drawn = picture.drawn_samples(of.tolerance_de00, of.pixel_samples);
    const double told = told_samples(*picture.stage.transport, picture.work(of.tolerance_de00, of.pixel_samples, true));
    EXPECT_LE(told, of.most * drawn) << of.name;
    EXPECT_GE(told, 0.5 * drawn) << of.name;

    Scene lit = picture.stage.scene;
    PathScene mesh_alone;
    mesh_alone.scene = &lit, mesh_alone.environment = &*picture.stage.environment;
    const auto split = envmap::sunlit_sky(*picture.stage.environment);
    if (split) lit.lights.push_back(light_of(split->sun)), mesh_alone.environment = &split->sky;
    const auto other = Transport::create(mesh_alone);
    ASSERT_TRUE(other.ok());
    const double control = told_samples(*other, picture.work(of.tolerance_de00, of.pixel_samples, false));
    worst_control = std::max(worst_control, drawn / control);
    ::testing::Test::RecordProperty(of.name, fmt::format("{:.0f}, told {:.0f}, control {:.0f}", drawn, told, control));
  }
  EXPECT_GT(worst_control, 2);
}

TEST(PathPrice, IsTheSameForAnyNumberOfThreads) {
  const Picture picture(ball_in_a_box(), dark_studio());
  const PathWork work = picture.work(1, 1, true);
  std::vector<double> samples;
  for (const int count : {1, 2, 5}) {
    set_threads(count);
    samples.push_back(path_price(*picture.stage.transport, work).samples);
  }
  set_threads(0);
  EXPECT_GT(samples[0], 16);
  EXPECT_EQ(samples[0], samples[1]);
  EXPECT_EQ(samples[0], samples[2]);
}

TEST(PathPrice, NothingCostsNothing) {
  const Picture picture(sphere_mesh(8), dark_studio());
  EXPECT_EQ(path_price(*picture.stage.transport, {}).ms, 0);
}

}  // namespace
}  // namespace goniochrome::render::path_price_test
