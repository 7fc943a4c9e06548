// The engine path as the renderer uses it: floors, samples of a pixel, limits, and rays in the place of OpenGL.
#include "render/path/path_engine.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/angles.h"
#include "render/internal/seen.h"
#include "render/path/path_tracer.h"
#include "render/path/scenes_for_paths_for_test.h"
#include "render/renderer.h"
#include "render/scene_effects.h"

namespace goniochrome::render::path_engine_test {
namespace {

using testing::HasSubstr;

// A ball of radius 1 in a paint, `above` its floor, under an environment.
struct World {
  mesh::Mesh mesh = sphere_mesh(64);
  envmap::PrefilteredEnvironment env;
  envmap::Environment source;
  envmap::BlockTree blocks;
  Scene scene;
  View view{Camera::orbit(mesh, 30, 25, 1.6, 30, 1), 48, 48, 1, false};

  World(envmap::Environment light, const paint::LobeFit& paint)
      : env(constant_env({1, 1, 1}, {})), source(std::move(light)), blocks(source) {
    scene.mesh = &mesh, scene.env = &env, scene.texels = &blocks, scene.paints = {paint};
  }
  World(const World&) = delete;

  void lay_ground(double height, double eye) {
    scene.ground.emplace();
    scene.ground->height = height;
    scene.ground->probe_eye = {0, height + eye, 0};
  }
  Frame drawn(double tolerance, const Effort& effort = {}) {
    Renderer renderer = Renderer::tracing(scene.ground);
    renderer.set_effort(effort);
    Effects effects = effects_of(scene);
    effects.tolerance_de00 = tolerance;
    const auto loaded = renderer.load(scene, effects, "path");
    if (!loaded.ok()) throw std::runtime_error(loaded.error().message);
    Frame frame;
    const auto done = renderer.draw(view, frame);
    if (!done.ok()) throw std::runtime_error(done.error().message);
    return frame;
  }
};

// Bright above the horizon, `ground` below it.
envmap::Environment two_halves(const color::Rgb& sky, const color::Rgb& ground) {
  return environment_of(32, 16, [&](int, int row) { return row < 8 ? sky : ground; });
}

color::Rgb at(const image::Image& image, int x, int y) {
  const float* p = image.pixel(x, y);
  return {p[0], p[1], p[2]};
}

// Light from below is nowhere; a black ball of radius 1 whose middle is d above the floor hides (1/d)^2 of the
// irradiance of the point under it (see light on a plane element under a sphere, [Howell] B-38), and leaves that much
// less of what the ground shows. A floor that is not darkened is the control.
TEST(ProjectedGround, UnderABallItLosesTheBallsFormFactor) {
  const color::Rgb ground{0.2, 0.1, 0.05};
  const envmap::Environment light = two_halves({1, 2, 3}, ground);
  for (const double d : {1.5, 2.5}) {
    PathStage stage(sphere_mesh(128), {matt({0, 0, 0})});
    stage.environment = light;
    PathScene path;
    path.scene = &stage.scene, path.environment = &*stage.environment;
    path.ground.emplace();
    path.ground->height = -d, path.ground->probe_eye = {0, 1, 0};
    auto made = Transport::create(path);
    ASSERT_TRUE(made.ok()) << made.error().message;
    stage.transport.emplace(*std::move(made));
    const PathEstimate seen = stage.seen({}, {3, -d + 0.2, 0}, {0, -d, 0}, 3000);
    const double left = 1 - 1 / (d * d);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(seen.radiance[c], left * ground[c], 5 * deviation(seen, c) + 2e-3 * ground[c]) << d;
      EXPECT_GT(ground[c] - seen.radiance[c], 20 * deviation(seen, c)) << "control";
    }
  }
}

// Where nothing takes light from it, the floor has the color of the environment along the line from the probe's eye to
// its point, without a sample's noise, even if the product of colors mixes channels.
TEST(ProjectedGround, InTheOpenItShowsWhatTheProbeSaw) {
  const auto pattern = [](int column, int row) {
    return row < 32 ? color::Rgb{1, 1, 1} : color::Rgb{0.1 + 0.01 * (column % 8), 0.3, 0.2 + 0.01 * (row % 5)};
  };
  World world(environment_of(128, 64, pattern), matt({0.5, 0.5, 0.5}));
  world.scene.reflection = color::iso_rgb_operator();
  world.lay_ground(-1, 2);
  world.view.camera = {{300, 4, 0}, {310, -1, 0}, {0, 1, 0}, 30};
  const Frame frame = world.drawn(0.5);
  const Rays through = *rays(world.view.camera, 48, 48);
  int compared = 0;
  for (int y = 0; y < 48; y += 5) {
    for (int x = 0; x < 48; x += 5) {
      const Vec3 direction = through.direction(x + 0.5, y + 0.5);
      if (direction.y > -0.05) continue;
      const Vec3 point = world.view.camera.eye + ((-1 - 4.0) / direction.y) * direction;
      const color::Rgb wanted = world.source.blended(normalized(point - Vec3{0, 1, 0}));
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(at(frame.picture, x, y)[c], wanted[c], 2e-4);
      ++compared;
    }
  }
  EXPECT_GT(compared, 20);
}

// A white floor under white light from all around is as bright as the light, and so is a white ball on it: nothing is
// lost between floor and ball. Without bounces the floor's shade is the control.
TEST(ProjectedGround, AWhiteBallOnAWhiteFloorInEvenLightIsNotSeen) {
  World world(even_environment(), matt({1, 1, 1}));
  world.lay_ground(-1, 2);
  Effort endless;
  endless.bounces = 1000;
  const Frame frame = world.drawn(0.3, endless);
  color::Rgb sum;
  int count = 0;
  double least = 1;
  Effort none;
  none.bounces = 0;
  const Frame dark = world.drawn(0.3, none);
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 48; ++x) {
      if (frame.picture.pixel(x, y)[3] == 0) continue;
      sum += at(frame.picture, x, y), ++count;
      least = std::min(least, at(dark.picture, x, y).y);
    }
  }
  // The mean over a thousand pixels of a noise of .3 dE00 (a lightness of .3, or .8 % of white) has a thirtieth of it.
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c] / count, 1, 2e-3);
  EXPECT_LT(least, 0.6) << "control";
}

// The environment is smooth at its poles, across its seam and within a cube's faces.
TEST(ProjectedGround, InterpolatesBetweenTexelCenters) {
  const auto light = environment_of(16, 8, [](int column, int row) { return color::Rgb{1.0 + column, 1.0 + row, 2}; });
  for (const auto& [column, row] : {std::pair{3, 4}, {0, 0}, {15, 7}}) {
    const color::Rgb there = light.blended(light.direction(column, row));
    EXPECT_NEAR(there.x, 1 + column, 1e-6);
    EXPECT_NEAR(there.y, 1 + row, 1e-6);
  }
  const color::Rgb between = light.blended(light.grid().direction_at(4.0, 4.5));
  EXPECT_NEAR(between.x, 1 + 3.5, 1e-6);
  const color::Rgb across = light.blended(light.grid().direction_at(16.0, 4.5));
  EXPECT_NEAR(across.x, (1 + 16) / 2.0, 1e-6);
}

// Each sample of a pixel counts alike: the picture of four is the mean of the pictures that each of them alone makes.
// One sample alone is the control.
TEST(PathPicture, SpreadsItsPathsOverTheSamplesOfAPixel) {
  PathStage stage(box_mesh(false), {matt({0.6, 0.6, 0.6})});
  for (std::size_t part = 0; part < stage.scene.paints.size(); ++part)
    stage.scene.paints[part] = matt((part % 2 == 0 ? 0.9 : 0.1) * color::Rgb{1, 1, 1});
  stage.environment = even_environment();
  const Transport& transport = stage.build();
  const Rays through = *rays(Camera{{1.5, 4, 2.5}, {0, -0.5, 0}, {0, 1, 0}, 30}, 24, 24);
  PathRequest request;
  request.tolerance_de00 = 0.3;
  const auto drawn = [&](int samples, const std::array<double, 2>& shift) {
    Rays shifted = through;
    shifted.corner += shift[0] * through.right + shift[1] * through.down;
    request.pixel_samples = samples;
    const Gbuffer surface = visible_surface(transport.rays(), shifted, 24, 24);
    const PathPicture picture = path_picture(transport, surface, nullptr, request);
    std::vector<double> values(24 * 24, 0);
    for (const PathPoint& point : picture.points)
      values[static_cast<std::size_t>(24 * point.y + point.x)] = point.radiance.y;
    return values;
  };
  const std::vector<double> four = drawn(4, {0, 0}), one = drawn(1, {0, 0});
  std::vector<double> mean(24 * 24, 0);
  for (const auto& shift : sample_shifts(4)) {
    const std::vector<double> single = drawn(1, shift);
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += 0.25 * single[i];
  }
  double largest = 0, control = 0;
  for (std::size_t i = 0; i < mean.size(); ++i) {
    largest = std::max(largest, std::abs(four[i] - mean[i]));
    control = std::max(control, std::abs(one[i] - mean[i]));
  }
  // A noise of .3 dE00 is 1 % of these radiances; the largest of 576 is below four of it, twice over.
  EXPECT_LT(largest, 0.08);
  EXPECT_GT(control, 0.15);
}

TEST(PathEngine, SaysHowNoisyItsPictureIs) {
  World world(two_halves({1, 1, 1}, {0.2, 0.2, 0.2}), matt({0.5, 0.4, 0.3}));
  world.lay_ground(-1, 2);
  world.view.samples = 4;
  const Frame rough = world.drawn(2), fine = world.drawn(0.5);
  ASSERT_TRUE(rough.noise && fine.noise);
  EXPECT_TRUE(fine.noise->reached);
  EXPECT_LE(fine.noise->de00_p95, 0.5);
  EXPECT_GT(fine.noise->samples_mean, rough.noise->samples_mean);
  // Stated noise covers the difference: the two pictures are as far apart as both noises together.
  std::vector<double> found, stated;
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 48; ++x) {
      if (rough.picture.pixel(x, y)[3] == 0) continue;
      found.push_back(seen_difference(at(rough.picture, x, y), at(fine.picture, x, y), 1));
      stated.push_back(std::hypot(*rough.noise->de00.pixel(x, y), *fine.noise->de00.pixel(x, y)));
    }
  }
  double squares = 0, expected = 0;
  for (std::size_t i = 0; i < found.size(); ++i) squares += found[i] * found[i], expected += stated[i] * stated[i];
  // White here is 1.0 of a diffuse white in the brighter half; the two need agree to a third only.
  EXPECT_NEAR(std::sqrt(squares / expected), 1, 0.35);
}

// A ball on a painted floor under a small bright light: smoothed pictures are as near to the truth as others, and their
// error is the one that is told. The samples of the others are the control.
TEST(PathEngine, SmoothedItNeedsFewSamplesForTheErrorThatItTells) {
  const auto light = [](int column, int row) {
    return row == 4 && column == 7 ? color::Rgb{60, 50, 40} : color::Rgb{1, 1, 1};
  };
  World world(environment_of(32, 16, light), matt({0.5, 0.4, 0.3}));
  world.scene.ground = {.kind = Ground::Kind::kPaint, .height = -1, .paint = matt({0.3, 0.3, 0.4})};
  world.view.width = world.view.height = 96, world.view.samples = 4;
  const Frame plain = world.drawn(1), smooth = world.drawn(1, {.smooth = true}), truth = world.drawn(0.25);
  EXPECT_TRUE(smooth.noise->reached);
  EXPECT_LT(smooth.noise->samples_mean, 0.5 * plain.noise->samples_mean);
  const auto p95 = [&](const Frame& frame) {
    std::vector<double> apart;
    for (int y = 0; y < 96; ++y)
      for (int x = 0; x < 96; ++x)
        if (truth.picture.pixel(x, y)[3] == 1)
          apart.push_back(
              seen_difference(at(frame.picture, x, y), at(truth.picture, x, y), truth.noise->white_luminance));
    EXPECT_GT(apart.size(), 5000U);
    return percentile_95(std::move(apart));
  };
  EXPECT_LT(p95(smooth), 1.25 * smooth.noise->de00_p95);
  EXPECT_LT(p95(smooth), p95(plain));
}

TEST(PathEngine, StopsAtItsTimeLimitWithThePictureSoFar) {
  World world(two_halves({1, 1, 1}, {0.2, 0.2, 0.2}), matt({0.5, 0.4, 0.3}));
  world.lay_ground(-1, 2);
  Effort hurried;
  hurried.time_limit_s = 0.01;
  const Frame frame = world.drawn(0.001, hurried);
  EXPECT_FALSE(frame.noise->reached);
  EXPECT_GT(frame.noise->de00_p95, 0.001);
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 48; ++x) {
      if (frame.picture.pixel(x, y)[3] == 1) {
        EXPECT_GT(at(frame.picture, x, y).y, 0) << x << "," << y;
      }
    }
}

TEST(PathEngine, TellsWhichPartsGainLight) {
  Scene scene;
  paint::LobeFit lobe, both;
  lobe.lobes = {{20, 0.9 * 21 / (2 * kPi) * color::Rgb{1, 1, 1}, {}}};
  both = lobe;
  both.diffuse = 0.2 / kPi * color::Rgb{1, 1, 1};
  scene.paints = {matt({1, 1, 1}), matt({0.5, 1.02, 0.5}), lobe, both};
  EXPECT_EQ(gaining_parts(scene), (std::vector<int>{1, 3}));
}

TEST(PathEngine, TellsWhatIsOddAboutTheScene) {
  World world(even_environment(), matt({1.2, 0.5, 0.5}));
  world.lay_ground(-0.5, 2);
  Renderer renderer = Renderer::tracing(world.scene.ground);
  ASSERT_TRUE(renderer.load(world.scene, "path").ok());
  EXPECT_THAT(renderer.remarks(),
              testing::ElementsAre(HasSubstr("the paint of sphere sends back more light than it gets"),
                                   HasSubstr("the floor at height -0.5 lies above the lowest point of the mesh")));
  world.scene.paints = {matt({1, 0.5, 0.5})};
  world.scene.ground->height = -1;
  Renderer other = Renderer::tracing(world.scene.ground);
  ASSERT_TRUE(other.load(world.scene, "path").ok());
  EXPECT_THAT(other.remarks(), testing::IsEmpty());
  world.scene.ground->probe_eye.y = -1;
  EXPECT_THAT(other.load(world.scene, "path").error().message, HasSubstr("the eye must be above it"));
}

TEST(PathEngine, OtherEnginesRefuseWhatOnlyRaysDraw) {
  World world(even_environment(), matt({0.5, 0.5, 0.5}));
  world.scene.emission = {{1, 1, 1}};
  for (const char* engine : {"cpu", "integral"}) {
    Renderer renderer = Renderer::tracing();
    EXPECT_THAT(renderer.load(world.scene, engine).error().message, HasSubstr(engine)) << engine;
  }
  Renderer renderer = Renderer::tracing();
  EXPECT_TRUE(renderer.load(world.scene, "path").ok());
}

// Rays in the place of OpenGL show the engine cpu the same G-buffer, but for pixels whose center lies within a rounding
// of an edge.
TEST(Tracing, ShowsTheEngineCpuWhatOpenGlShows) {
  const mesh::Mesh mesh = box_mesh(false);
  const envmap::PrefilteredEnvironment env = uneven_env({6, 40}, {16, 24});
  paint::LobeFit paint = matt({0.3, 0.2, 0.1});
  paint.lobes = {{6, {0.05, 0.1, 0.02}, {}}, {40, {0.2, 0.3, 0.1}, {0.1, 0.1, 0.1}}};
  const Scene scene{&mesh, std::vector<paint::LobeFit>(mesh.parts.size(), paint), &env, {}, Background::kNone, {}};
  const Camera camera = Camera::orbit(mesh, 30, 40, 1, 30, 1);
  auto gl = Renderer::create();
  ASSERT_TRUE(gl.ok());
  Renderer traced = Renderer::tracing();
  Frame frames[2];
  Renderer* renderers[] = {&*gl, &traced};
  for (std::size_t i = 0; i < 2; ++i) {
    ASSERT_TRUE(renderers[i]->load(scene, "cpu").ok());
    ASSERT_TRUE(renderers[i]->draw({camera, 96, 96, 4, false}, frames[i]).ok());
  }
  EXPECT_EQ(traced.opengl(), "");
  int apart = 0, covered = 0;
  for (int y = 0; y < 96; ++y) {
    for (int x = 0; x < 96; ++x) {
      covered += frames[0].picture.pixel(x, y)[3] > 0 ? 1 : 0;
      bool same = true;
      for (int c = 0; c < 4; ++c)
        same = same && std::abs(frames[0].picture.pixel(x, y)[c] - frames[1].picture.pixel(x, y)[c]) < 1e-4;
      apart += same ? 0 : 1;
    }
  }
  EXPECT_GT(covered, 2000);
  EXPECT_LT(apart, 20);
  EXPECT_FALSE(traced.load(scene, "gl").ok());
}

}  // namespace
}  // namespace goniochrome::render::path_engine_test
