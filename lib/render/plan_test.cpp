// The plan: its effects, the effects that it leaves out, and whether its estimates are those of the pictures.
#include "render/plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "color/color.h"
#include "envmap/environment.h"
#include "render/cpu/cpu_engine.h"
#include "render/effect_words.h"
#include "render/internal/seen.h"
#include "render/planning.h"
#include "render/renderer.h"
#include "render/scene_effects.h"
#include "render/scenes_for_test.h"

namespace goniochrome::render::plan_test {
namespace {

using testing::HasSubstr;

struct World {
  mesh::Mesh mesh = sphere_mesh(64);
  envmap::PrefilteredEnvironment env = constant_env({1, 1, 1}, {6, 40, 900});
  Scene scene;
  View view;
  explicit World(paint::LobeFit paint) {
    scene.mesh = &mesh;
    scene.paints = {std::move(paint)};
    scene.env = &env;
    view = {Camera::orbit(mesh, 30, 20, 1, 30, 1), 96, 96, 1, false};
  }
};

paint::LobeFit flake_paint() {
  paint::LobeFit paint = matt({0.1, 0.2, 0.05});
  paint.lobes = {{6, {0.05, 0.1, 0.02}, {}}, {40, {0.2, 0.3, 0.1}, {}}, {900, {}, {5, 5, 5}}};
  return paint;
}

struct Planned {
  Plan plan;
  std::vector<color::Rgb> colors;  // of every visible pixel
};

Planned planned(const World& world, PlanRequest request = {}) {
  auto renderer = Renderer::create();
  EXPECT_TRUE(renderer.ok());
  const auto seen = renderer->look(world.mesh, world.view);
  EXPECT_TRUE(seen.ok());
  auto plan = renderer->load(world.scene, {*seen}, request);
  EXPECT_TRUE(plan.ok()) << plan.error().message;
  Frame frame;
  EXPECT_TRUE(renderer->draw(world.view, frame).ok());
  Planned result{*std::move(plan), {}};
  for (int y = 0; y < 96; ++y) {
    for (int x = 0; x < 96; ++x) {
      const float* p = frame.picture.pixel(x, y);
      if (frame.gbuffer->part(x, y) >= 0) result.colors.push_back({p[0], p[1], p[2]});
    }
  }
  return result;
}

double p95(const std::vector<color::Rgb>& a, const std::vector<color::Rgb>& b) {
  std::vector<double> de00;
  for (std::size_t i = 0; i < a.size(); ++i) de00.push_back(seen_difference(a[i], b[i], 1));
  return percentile_95(std::move(de00));
}

const PlanItem& item(const Plan& plan, const std::string& effect) {
  const auto found =
      std::find_if(plan.items.begin(), plan.items.end(), [&](const PlanItem& i) { return i.effect == effect; });
  EXPECT_NE(found, plan.items.end()) << effect;
  return *found;
}

PlanRequest with_effects_of(const std::string& effects) {
  PlanRequest request;
  request.effects = *words_of(effects);
  return request;
}

TEST(Plan, AsksOnlyForWhatTheSceneCallsFor) {
  World solid(matt({0.5, 0.2, 0.1}));
  solid.scene.reflection = color::working_space_operator();
  const Plan plan = planned(solid).plan;
  EXPECT_TRUE(item(plan, "diffuse").on);
  for (const char* name :
       {"lobes", "gloss", "mirror", "fresnel", "horizon", "anisotropy", "travel", "lights", "operator"}) {
    EXPECT_FALSE(item(plan, name).needed) << name;
    EXPECT_EQ(item(plan, name).decision, Decision::kNotInScene) << name;
  }
  EXPECT_THAT(item(plan, "lobes").reason, HasSubstr("solid"));
  EXPECT_THAT(item(plan, "operator").reason, HasSubstr("white light"));
  EXPECT_FALSE(plan.effects.reflection);
}

TEST(Plan, ColoredLightCallsForTheOperator) {
  World world(matt({0.6, 0.1, 0.1}));
  world.scene.reflection = color::working_space_operator();
  world.env.diffuse.map = cube_of(4, [](const Vec3&) { return Vec3{0.1, 0.9, 1}; });
  const Plan plan = planned(world).plan;
  EXPECT_TRUE(item(plan, "operator").on) << "it is as fast as the plain product";
  EXPECT_THAT(item(plan, "operator").reason, HasSubstr("colored light"));
  EXPECT_GT(item(planned(world, with_effects_of("auto,-operator")).plan, "operator").de00_p95, 2);
}

// Every effect forced off changes the picture by what the plan said it would: the same percentile of 512 points and of
// all. For a smooth distribution of n = 512 points the 95th percentile wanders between the 92.5th and the 97.5th.
TEST(Plan, EstimatesAreTheChangesOfThePicture) {
  World world(flake_paint());
  world.scene.lights = {{normalized({1, 2, 3}), {0.4, 0.4, 0.4}}};
  world.scene.anisotropy = {{0.05, 0.4}};
  world.env.lobes[1].map = cube_of(16, [](const Vec3& d) { return Vec3{1 + d.x, 1 + d.x, 1 - 0.5 * d.y}; });
  const Planned all = planned(world, with_effects_of("all"));
  int seen = 0;
  for (const PlanItem& i : all.plan.items) {
    if (!i.needed) continue;
    PlanRequest request;
    request.effects = {Start::kAll, {{i.effect, false}}};
    const Planned without = planned(world, request);
    EXPECT_EQ(item(without.plan, i.effect).decision, Decision::kForcedOff);
    EXPECT_NEAR(p95(all.colors, without.colors), i.de00_p95, 0.2 * i.de00_p95 + 0.02) << i.effect;
    seen += i.de00_p95 > 0.1 ? 1 : 0;
  }
  EXPECT_GE(seen, 6);
}

TEST(Plan, WhatIsLeftOutStaysWithinTheTolerance) {
  World world(flake_paint());
  world.scene.lights = {{normalized({1, 2, 3}), {0.02, 0.02, 0.02}}};
  const Planned all = planned(world, with_effects_of("all"));
  int dropped = 0;
  for (const double tolerance : {0.05, 0.5, 2.0, 8.0}) {
    PlanRequest request;
    request.tolerance_de00 = tolerance;
    const Planned some = planned(world, request);
    EXPECT_LE(some.plan.de00_p95, tolerance);
    EXPECT_LE(p95(all.colors, some.colors), tolerance);
    int here = 0;
    for (const PlanItem& i : some.plan.items) here += i.decision == Decision::kDropped ? 1 : 0;
    EXPECT_GE(here, dropped) << "a larger tolerance leaves out no less";
    dropped = here;
  }
  EXPECT_GE(dropped, 2);
}

// A highlight lies between the points of a plan, and is all that such a picture shows. The control: at 95 of 100 points
// the lamp is worth nothing, by which alone it would be left out.
TEST(Plan, AHighlightBetweenThePointsIsDrawn) {
  paint::LobeFit gloss = matt({0, 0, 0});
  gloss.lobes = {{900, {}, {0.3, 0, 0}}};
  World world(gloss);
  world.scene.env = nullptr;
  world.scene.lights = {{normalized({0.3, 0.4, 1}), {1, 1, 1}}};
  const Planned some = planned(world), all = planned(world, with_effects_of("all"));
  EXPECT_EQ(item(some.plan, "lights").de00_p95, 0) << "the control";
  EXPECT_EQ(item(some.plan, "gloss-900").de00_p95, 0) << "the control";
  EXPECT_TRUE(item(some.plan, "lights").on);
  EXPECT_TRUE(item(some.plan, "gloss-900").on);
  EXPECT_EQ(some.colors, all.colors);
  EXPECT_GT(std::ranges::max(some.colors, {}, &color::Rgb::x).x, 0.01);
  // A lobe that nobody sees in its highlight either is left out.
  world.scene.paints[0].lobes = {{900, {}, {1e-6, 1e-6, 1e-6}}};
  EXPECT_FALSE(item(planned(world).plan, "gloss-900").on);
}

// The horizon cuts a lobe by the maps of the others. A lobe that is off has no part in that, so that a plan tries out
// what a picture without its map shows. The control keeps the map, and shows another picture.
TEST(Plan, ALobeThatIsOffIsTriedOutWithoutItsMap) {
  paint::LobeFit paint = matt({0.05, 0.05, 0.04});
  paint.lobes = {{6, {1e-3, 1e-3, 1e-3}, {}}, {40, {0.3, 0.3, 0.2}, {}}};
  World world(paint);
  world.env.lobes[0].map = cube_of(8, [](const Vec3& d) { return d.y > 0 ? Vec3{0.1, 0.1, 0.1} : Vec3{8, 8, 8}; });
  world.env.lobes[1].map = cube_of(16, [](const Vec3& d) { return d.y > 0 ? Vec3{2, 2, 2} : Vec3{0.1, 0.1, 0.1}; });
  const Effects all = effects_of(world.scene);
  Effects off = all, gone = all;
  off.lobes[0].directional_diffuse = false;
  gone.lobes.erase(gone.lobes.begin());
  std::vector<VisiblePoint> points;
  for (double t = 0; t < 1.5; t += 0.05) points.push_back({{0, 0, 1}, {0, std::sin(t), std::cos(t)}, 0});
  CpuEngine tried, drawn;
  ASSERT_TRUE(tried.load(world.scene, all).ok());
  ASSERT_TRUE(drawn.load(world.scene, gone).ok());
  tried.load_paints(world.scene, off);
  const auto apart = [&] {
    std::vector<double> de00;
    const auto a = tried.colors(points), b = drawn.colors(points);
    for (std::size_t i = 0; i < a.size(); ++i) de00.push_back(seen_difference(a[i], b[i], 1));
    return std::ranges::max(de00);
  };
  EXPECT_LT(apart(), 0.01);
  Scene without = world.scene;
  without.paints[0].lobes.erase(without.paints[0].lobes.begin());
  tried.load_paints(without, all);
  EXPECT_GT(apart(), 0.3) << "the control";
}

TEST(Plan, LobesNobodySeesAreNotLoaded) {
  World world(matt({0.5, 0.5, 0.5}));
  world.mesh = panels_mesh(2);
  paint::LobeFit hidden = flake_paint();
  hidden.lobes.push_back({33, {1, 1, 1}, {}});  // the environment has no such map
  world.scene.paints = {matt({0.5, 0.5, 0.5}), hidden};
  world.view.camera.eye = {-0.5, 0, 0.5};
  world.view.camera.target = {-0.5, 0, 0};
  const Planned result = planned(world);
  EXPECT_TRUE(result.plan.effects.lobes.empty());
}

TEST(Plan, WordsAreCheckedAndForced) {
  EXPECT_EQ(*words_of("auto"), EffectWords());
  EXPECT_EQ(*words_of("none, +diffuse,-travel-2,+satin"),
            (EffectWords{Start::kNone, {{"diffuse", true}, {"tilts-2", false}, {"satin", true}, {"stretch", true}}}));
  EXPECT_THAT(words_of("fast").error().message, HasSubstr("auto, all or none"));
  for (const char* text : {"all,-shine", "auto,+tilt", "all,-lobe-x"})
    EXPECT_THAT(words_of(text).error().message, HasSubstr("there are diffuse, lobes, gloss")) << text;
  EXPECT_THAT(words_of("auto,-tilts-2").error().message, HasSubstr("\"tilts-2\", which is gone: write travel"));
  World world(flake_paint());
  const Plan plan = planned(world, with_effects_of("none,+lobe-40")).plan;
  for (const PlanItem& i : plan.items) EXPECT_EQ(i.on, i.effect == "lobe-40") << i.effect;
  ASSERT_EQ(plan.effects.lobes.size(), 1U);
  EXPECT_EQ(plan.effects.lobes[0].exponent, 40);
}

TEST(Plan, TruthStandsBesideTheEstimate) {
  World world(flake_paint());
  Planned result = planned(world, with_effects_of("all"));
  image::Image image{64, 32, 3, std::vector<float>(64 * 32 * 3, 1.0F), {}};
  const auto env =
      envmap::Environment::from_lat_long(std::move(image), envmap::Environment::BadPixels::kError, "constant");
  auto renderer = Renderer::create();
  const auto seen = renderer->look(world.mesh, world.view);
  add_truth(result.plan, world.scene, probe_points(probe_pixels({*seen}, 60), {}, 1), &*env, 1);
  int compared = 0;
  for (const PlanItem& i : result.plan.items) {
    EXPECT_EQ(i.truth_de00_p95.has_value(), i.needed);
    if (!i.needed || i.de00_p95 < 0.3) continue;
    EXPECT_LT(*i.truth_de00_p95, 2 * i.de00_p95) << i.effect;
    EXPECT_GT(*i.truth_de00_p95, 0.5 * i.de00_p95) << i.effect;
    ++compared;
  }
  EXPECT_GE(compared, 5);
}

}  // namespace
}  // namespace goniochrome::render::plan_test
