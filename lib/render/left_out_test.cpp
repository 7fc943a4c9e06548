#include "render/left_out.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "render/internal/seen.h"
#include "render/scene_effects.h"
#include "render/scenes_for_test.h"

namespace goniochrome::render::left_out_test {
namespace {

constexpr int kSize = 64;

struct World {
  mesh::Mesh mesh = sphere_mesh(64);
  envmap::PrefilteredEnvironment env = constant_env({1, 1, 1}, {6, 40});
  Scene scene;
  View view;
  World() {
    paint::LobeFit paint = matt({0.1, 0.2, 0.05});
    paint.lobes = {{6, {0.05, 0.1, 0.02}, {}}, {40, {0.2, 0.3, 0.1}, {}}};
    scene.mesh = &mesh, scene.env = &env, scene.paints = {paint};
    view = {Camera::orbit(mesh, 30, 20, 1, 30, 1), kSize, kSize, 1, false};
  }
  image::Image draw(const Effects& effects) const {
    auto renderer = Renderer::create();
    EXPECT_TRUE(renderer->load(scene, effects, "cpu").ok());
    Frame frame;
    EXPECT_TRUE(renderer->draw(view, frame).ok());
    return frame.picture;
  }
};

// Effects that a plan leaves out of the world, and the picture of the renderer after they were measured.
struct Measured {
  std::shared_ptr<const Gbuffer> seen;
  LeftOut left;
  image::Image after;
};
Measured measured(const World& world, const std::string& effects) {
  Measured result;
  auto renderer = Renderer::create();
  EXPECT_TRUE(renderer.ok()) << renderer.error().message;
  result.seen = *renderer->look(world.mesh, world.view);
  PlanRequest request;
  request.effects = *words_of(effects), request.engine = "cpu";
  const auto plan = renderer->load(world.scene, {result.seen}, request);
  EXPECT_TRUE(plan.ok());
  const auto left = left_out(*renderer, world.scene, *plan, world.view, 1);
  EXPECT_TRUE(left.ok());
  result.left = *left;
  Frame frame;
  EXPECT_TRUE(renderer->draw(world.view, frame).ok());
  result.after = std::move(frame.picture);
  return result;
}

TEST(LeftOut, IsTheDifferenceOfThePlannedPictureFromThatOfAllEffects) {
  const World world;
  const Measured result = measured(world, "all,-diffuse");
  Effects without = effects_of(world.scene);
  without.diffuse = false;
  const image::Image full = world.draw(effects_of(world.scene)), planned = world.draw(without);
  std::vector<double> de00;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const float *a = planned.pixel(x, y), *b = full.pixel(x, y);
      if (result.seen->part(x, y) >= 0) de00.push_back(seen_difference({a[0], a[1], a[2]}, {b[0], b[1], b[2]}, 1));
    }
  }
  const LeftOut& left = result.left;
  EXPECT_GT(left.de00_p95, 5) << "the diffuse part of a green paint is seen";
  EXPECT_DOUBLE_EQ(left.de00_max, *std::max_element(de00.begin(), de00.end()));
  EXPECT_DOUBLE_EQ(left.de00_p95, percentile_95(std::move(de00)));
  EXPECT_GT(left.planned_ms, 0);
  EXPECT_GT(left.full_ms, 0);
  EXPECT_EQ(result.after.data, planned.data) << "the renderer is left as planned";
}

TEST(LeftOut, IsNothingWhereAllIsDrawn) {
  const LeftOut left = measured(World(), "all").left;
  EXPECT_EQ(left.de00_max, 0);
  EXPECT_EQ(left.full_ms, left.planned_ms);
}

}  // namespace
}  // namespace goniochrome::render::left_out_test
