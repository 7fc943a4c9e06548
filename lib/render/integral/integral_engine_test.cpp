// The engine that sums the environment itself, against the reference integrator: how far it is off for what was asked.
#include "render/integral/integral_engine.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/parallel.h"
#include "render/exact.h"
#include "render/picture_error.h"
#include "render/renderer.h"
#include "render/scene_effects.h"
#include "render/scenes_for_test.h"

namespace goniochrome::render::integral_engine_test {
namespace {

using testing::HasSubstr;

envmap::Environment lat_long(const std::function<Vec3(int column, int row)>& radiance) {
  image::Image image{128, 64, 3, {}, {}};
  for (int row = 0; row < 64; ++row) {
    for (int column = 0; column < 128; ++column) {
      const Vec3 value = radiance(column, row);
      for (int c = 0; c < 3; ++c) image.data.push_back(static_cast<float>(value[c]));
    }
  }
  return *envmap::Environment::from_lat_long(std::move(image), envmap::Environment::BadPixels::kError, "made");
}

// A hall that is hard on blocks: a long thin lamp, a colored window in a wall, a small sun and a floor's edge.
envmap::Environment hall() {
  return lat_long([](int column, int row) {
    if (row == 14 && column > 10 && column < 60) return Vec3{40, 38, 30};
    if (row == 22 && column == 90) return Vec3{3000, 2500, 1500};
    if (row > 16 && row < 28 && column > 100 && column < 116) return column < 108 ? Vec3{0.2, 0.5, 6} : Vec3{5, 1, 0.1};
    return row < 32 ? Vec3{0.3, 0.35, 0.5} : Vec3{0.06, 0.05, 0.04};
  });
}

struct World {
  explicit World(envmap::Environment made) : source(std::move(made)), blocks(source) {
    scene.mesh = &mesh, scene.env = &env, scene.texels = &blocks;
    scene.paints = {matt({0.02, 0.02, 0.02})};
    scene.paints[0].lobes = {{1.3, {0.05, 0.04, 0.03}, {}},
                             {6, {0.1, 0.1, 0.12}, {}},
                             {60, {0.4, 0.4, 0.4}, {0.02, 0.02, 0.02}},
                             {900, {}, {3, 3, 3}},
                             {paint::kMirrorExponent, {}, {1, 1, 1}}};
  }
  Result<Frame> drawn(Effects effects, double tolerance, int size = 48) const {
    effects.tolerance_de00 = tolerance;
    auto renderer = Renderer::create();
    if (!renderer.ok()) return renderer.error();
    if (auto loaded = renderer->load(scene, effects, "integral"); !loaded.ok()) return loaded.error();
    return renderer->draw(Camera::orbit(mesh, 30, 20, 1, 30, 1), size, size, 1, true);
  }
  Result<Frame> drawn(double tolerance) const { return drawn(effects_of(scene), tolerance); }
  PictureError error(const Frame& frame, int count = 200) const {
    return picture_error(frame, scene, &source, 1, count, 5);
  }

  envmap::Environment source;
  envmap::BlockTree blocks;
  mesh::Mesh mesh = sphere_mesh(64);
  envmap::PrefilteredEnvironment env = constant_env({1, 1, 1}, {1.3, 6, 60, 900});
  Scene scene;
};

TEST(IntegralEngine, IsWithinWhatIsAsked) {
  const World world(hall());
  for (const double tolerance : {2.0, 0.5, 0.1}) {
    const auto frame = world.drawn(tolerance);
    ASSERT_TRUE(frame.ok()) << frame.error().message;
    const PictureError error = world.error(*frame);
    EXPECT_EQ(error.checked_pixels, 200);
    EXPECT_LE(error.de00_p95, tolerance);
  }
  // The control: what is enough for 2 is not for 0.1.
  EXPECT_GT(world.error(*world.drawn(2)).de00_p95, 0.1);
}

TEST(IntegralEngine, DrawsEveryEffect) {
  World world(hall());
  world.scene.anisotropy = {{0.05, 0.1}};
  world.scene.lights = {{normalized({0.3, 0.6, 1}), {0.3, 0.5, 0.2}}};
  world.scene.reflection = color::iso_rgb_operator();
  Effects effects = effects_of(world.scene);
  const auto frame = world.drawn(effects, 0.5, 16);
  ASSERT_TRUE(frame.ok()) << frame.error().message;
  EXPECT_LE(world.error(*frame, 40).de00_p95, 0.5);
}

// Every block tells the direction of its only texel.
TEST(IntegralEngine, KeepsALoneSun) {
  const World world(lat_long([](int column, int row) {
    return column == 70 && row == 20 ? Vec3{1e9, 1e9, 1e9} : Vec3{};
  }));
  const auto frame = world.drawn(0.5);
  ASSERT_TRUE(frame.ok());
  const auto& g = *frame->gbuffer;
  int lit = 0;
  for (int y = 0; y < g.height; y += 5) {
    for (int x = 0; x < g.width; x += 5) {
      if (g.part(x, y) < 0) continue;
      const color::Rgb truth =
          exact_radiance({{g.normal(x, y), g.to_viewer(x, y), 0}}, world.scene, effects_of(world.scene), &world.source)
              .front();
      lit += truth.y > 0;
      // A texel's width, 0.05 rad, is a part of the lobe of exponent 60: (0.05 * 8)^2 / 24 of it, and of 900 more,
      // where both cut it in pieces.
      EXPECT_NEAR(frame->picture.pixel(x, y)[1], truth.y, 0.02 * truth.y);
    }
  }
  EXPECT_GT(lit, 15);
}

TEST(IntegralEngine, ConstantLightIsTheAlbedo) {
  const World world(lat_long([](int, int) { return Vec3{1, 1, 1}; }));
  const auto frame = world.drawn(0.1);
  ASSERT_TRUE(frame.ok());
  EXPECT_LE(world.error(*frame).de00_p95, 0.1);
}

TEST(IntegralEngine, LightsAloneAreThoseOfTheProcessor) {
  World world(hall());
  world.scene.env = nullptr, world.scene.texels = nullptr;
  world.scene.lights = {{normalized({0.3, 0.6, 1}), {0.3, 0.5, 0.2}}, {normalized({-1, 0.2, 0.4}), {1, 0.2, 0.2}}};
  world.scene.background = Background::kColor, world.scene.background_color = {0.1, 0.2, 0.3};
  const auto frame = world.drawn(0.5);
  ASSERT_TRUE(frame.ok()) << frame.error().message;
  auto renderer = Renderer::create();
  ASSERT_TRUE(renderer->load(world.scene, "cpu").ok());
  const auto mapped = renderer->draw(Camera::orbit(world.mesh, 30, 20, 1, 30, 1), 48, 48, 1);
  ASSERT_TRUE(mapped.ok());
  for (std::size_t i = 0; i < frame->picture.data.size(); ++i)
    EXPECT_NEAR(frame->picture.data[i], mapped->picture.data[i], 2e-5 * (1 + mapped->picture.data[i])) << i;
}

TEST(IntegralEngine, SamplesAreAveraged) {
  const World world(hall());
  Effects effects = effects_of(world.scene);
  effects.tolerance_de00 = 4;  // the coarsest
  auto renderer = Renderer::create();
  ASSERT_TRUE(renderer->load(world.scene, effects, "integral").ok());
  const Camera camera = Camera::orbit(world.mesh, 30, 20, 1, 30, 1);
  const auto one = renderer->draw(camera, 32, 32, 1), four = renderer->draw(camera, 32, 32, 4);
  ASSERT_TRUE(one.ok() && four.ok());
  double sum_one = 0, sum_four = 0;
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) {
      sum_one += one->picture.pixel(x, y)[3], sum_four += four->picture.pixel(x, y)[3];
      EXPECT_LE(four->picture.pixel(x, y)[3], 1.0001F);
    }
  }
  EXPECT_NEAR(sum_four, sum_one, 0.02 * sum_one);
  EXPECT_NEAR(four->picture.pixel(16, 16)[1], one->picture.pixel(16, 16)[1], 0.3 * one->picture.pixel(16, 16)[1]);
}

TEST(IntegralEngine, GivesTheSameBitsForAnyThreads) {
  const World world(hall());
  std::vector<float> first;
  for (const int count : {1, 2, 7}) {
    set_threads(count);
    const auto frame = world.drawn(2);
    ASSERT_TRUE(frame.ok());
    if (first.empty()) first = frame->picture.data;
    EXPECT_EQ(frame->picture.data, first) << count;
  }
  set_threads(0);
}

TEST(IntegralEngine, ThePlanKeepsEverything) {
  const World world(hall());
  auto renderer = Renderer::create();
  const View view{Camera::orbit(world.mesh, 30, 20, 1, 30, 1), 96, 96, 1, false};
  const auto seen = renderer->look(world.mesh, view);
  ASSERT_TRUE(seen.ok());
  PlanRequest request;
  request.engine = "integral";
  const auto plan = renderer->load(world.scene, {*seen}, request);
  ASSERT_TRUE(plan.ok()) << plan.error().message;
  for (const PlanItem& item : plan->items) EXPECT_EQ(item.on, item.needed) << item.effect;
  EXPECT_EQ(plan->effects.tolerance_de00, request.tolerance_de00);
}

TEST(IntegralEngine, WantsTheImageItself) {
  World world(hall());
  world.scene.texels = nullptr;
  const auto frame = world.drawn(0.5);
  ASSERT_FALSE(frame.ok());
  EXPECT_THAT(frame.error().message, HasSubstr("the engine integral sums the image"));
}

}  // namespace
}  // namespace goniochrome::render::integral_engine_test
