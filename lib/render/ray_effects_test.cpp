// Pictures with the effects of rays, against the truth and against pictures without them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/internal/bands.h"
#include "render/internal/seen.h"
#include "render/path/scenes_for_paths_for_test.h"
#include "render/plan/ray_plan.h"
#include "render/planning.h"
#include "render/renderer.h"
#include "render/truth.h"

namespace goniochrome::render::ray_effects_test {
namespace {

struct World {
  mesh::Mesh mesh;
  envmap::PrefilteredEnvironment env = constant_env({1, 1, 1}, {20, 900});
  envmap::Environment sky = even_environment();
  Scene scene;
  View view;

  explicit World(mesh::Mesh made) : mesh(std::move(made)) {
    paint::LobeFit paint = matt({0.5, 0.4, 0.3});
    paint.lobes = {{20, {0.3, 0.3, 0.3}, {}}};
    scene.mesh = &mesh;
    scene.paints.assign(mesh.parts.size(), paint);
    scene.env = &env;
    view = {Camera::orbit(mesh, 30, 35, 1, 30, 1), 32, 32, 1, true};
  }
  World(const World&) = delete;
};

mesh::Mesh ball_in_a_cup() {
  mesh::Mesh mesh = box_mesh(false);
  add_mesh(mesh, sphere_mesh(32), 0.5, {0.1, -0.5, 0});
  return mesh;
}

struct Drawn {
  Plan plan;
  Frame frame;
};

Drawn drawn(const World& world, const EffectWords& effects, bool rays, int samples = 1,
            double tolerance_de00 = PlanRequest{}.tolerance_de00) {
  auto renderer = Renderer::create();
  EXPECT_TRUE(renderer.ok());
  RaySetup setup;
  setup.environment = &world.sky;
  if (rays) renderer->set_rays(setup);
  View view = world.view;
  view.samples = samples;
  const auto seen = renderer->look(world.mesh, view);
  EXPECT_TRUE(seen.ok());
  PlanRequest request;
  request.effects = effects;
  request.samples = samples;
  request.tolerance_de00 = tolerance_de00;
  auto plan = renderer->load(world.scene, {*seen}, request);
  EXPECT_TRUE(plan.ok()) << plan.error().message;
  Drawn result{*std::move(plan), {}};
  EXPECT_TRUE(renderer->draw(view, result.frame).ok());
  add_findings(result.frame.rays, result.frame.maps, result.plan);
  return result;
}

TruthError against_truth(const World& world, const Drawn& picture) {
  TruthRequest request;
  request.environment = &world.sky;
  request.count = 100;
  request.bounces = Effort::kUsualBounces;
  request.seed = 5;
  auto error = truth_error(picture.frame, world.scene, picture.plan.effects.rays, request);
  EXPECT_TRUE(error.ok());
  return *error;
}

const PlanItem& item(const Plan& plan, const std::string& effect) {
  return *std::ranges::find(plan.items, effect, &PlanItem::effect);
}

TEST(RayEffects, ABallIsDrawnAsBefore) {
  const World world(sphere_mesh(48));
  const Drawn before = drawn(world, {}, false), after = drawn(world, {}, true);
  EXPECT_EQ(before.frame.picture.data, after.frame.picture.data);
  for (const std::string name : {"shadow", "self", "bounce"}) {
    EXPECT_FALSE(item(after.plan, name).needed);
    EXPECT_EQ(item(after.plan, name).decision, Decision::kNotInScene);
  }
}

// In even light prefiltered maps are exact but for the horizon, so that the error of a picture is the change by the
// mesh.
TEST(RayEffects, APictureWithThemIsTheTruth) {
  const World world(ball_in_a_cup());
  const Drawn planned = drawn(world, {}, true), with = drawn(world, {Start::kAll}, true),
              without = drawn(world, {Start::kAll, {{"shadow", false}}}, true);
  for (const std::string name : {"shadow", "self", "bounce"}) {
    EXPECT_EQ(item(planned.plan, name).decision, Decision::kDrawn) << name;
    EXPECT_GT(item(planned.plan, name).de00_p95, 1) << name;
    EXPECT_EQ(item(without.plan, name).decision, Decision::kForcedOff) << name;
  }
  const TruthError good = against_truth(world, with), bad = against_truth(world, without);
  // The maps err by less than the tolerance here.
  EXPECT_LT(good.total.de00_p95, 2 * PlanRequest{}.tolerance_de00);
  EXPECT_EQ(good.shares.occlusion, 0);
  EXPECT_EQ(good.shares.bounce, 0);
  // Control: what was left out is found, and by its name.
  EXPECT_TRUE(bad.sharp);
  EXPECT_GT(bad.total.de00_p95, 5);
  EXPECT_GT(bad.shares.occlusion, 5);
  EXPECT_GT(bad.shares.bounce, 1);
  EXPECT_EQ(bad.shares.noise, 0);
  // The error of the maps is seen on top of the truth, which has its own noise and, of the better picture, more
  // samples.
  EXPECT_NEAR(bad.shares.prefilter, good.shares.prefilter, 0.1 * PlanRequest{}.tolerance_de00);
  // The first pass tells what leaving shadows out is worth: 100 pixels of 95 % lie between the 90th and the 99th.
  EXPECT_NEAR(item(with.plan, "shadow").de00_p95, bad.worth.shadow, 0.3 * bad.worth.shadow);
  EXPECT_NEAR(item(with.plan, "self").de00_p95, bad.worth.self, 0.3 * bad.worth.self);
  EXPECT_NEAR(item(with.plan, "bounce").de00_p95, bad.worth.bounce, 0.3 * bad.worth.bounce);
}

// A share that nobody sees gets no second pass: its first samples stay in the picture, which is the truth all the same.
// The control: where it is seen, it goes on.
TEST(RayEffects, WhatTheFirstPassShowsToBeUnseenStops) {
  World dark(ball_in_a_cup());
  dark.scene.paints.assign(dark.mesh.parts.size(), matt({0.006, 0.006, 0.006}));
  const Drawn stopped = drawn(dark, {}, true);
  EXPECT_EQ(item(stopped.plan, "shadow").decision, Decision::kDrawn);
  EXPECT_EQ(item(stopped.plan, "bounce").decision, Decision::kFirstPass);
  EXPECT_EQ(item(stopped.plan, "self").decision, Decision::kFirstPass) << "there are no lobes";
  EXPECT_LT(item(stopped.plan, "bounce").de00_p95, 0.25 * PlanRequest{}.tolerance_de00);
  const TruthError error = against_truth(dark, stopped);
  EXPECT_LT(error.total.de00_p95, 2 * PlanRequest{}.tolerance_de00);
  const Drawn control = drawn(World(ball_in_a_cup()), {}, true);
  EXPECT_EQ(item(control.plan, "bounce").decision, Decision::kDrawn);
}

// The truth is known to a tenth of the difference because the few noisy points are traced on. The control: the same
// batches for all. Both agree within three times what they say of themselves.
TEST(RayEffects, NoisyPointsOfTheTruthAreTracedOn) {
  const World world(ball_in_a_cup());
  const Drawn picture = drawn(world, {Start::kAll}, true);
  TruthRequest request;
  request.environment = &world.sky;
  request.seed = 5;
  request.batches = request.most_batches = 16;
  const TruthError same = *truth_error(picture.frame, world.scene, picture.plan.effects.rays, request);
  request.most_batches = TruthRequest{}.most_batches;
  const TruthError on = *truth_error(picture.frame, world.scene, picture.plan.effects.rays, request);
  EXPECT_FALSE(same.sharp) << "the control must fail";
  EXPECT_TRUE(on.sharp);
  EXPECT_LT(on.standard_error, 0.1 * on.total.de00_p95);
  EXPECT_LT(on.standard_error, 0.8 * same.standard_error);
  EXPECT_NEAR(on.total.de00_p95, same.total.de00_p95, 3 * same.standard_error);
}

// Maps are measured beside sums at some points, and rays have what they leave of the tolerance.
TEST(RayEffects, RaysLeaveToTheMapsWhatTheyMiss) {
  constexpr double kTolerance_de00 = 0.4;
  const World world(ball_in_a_cup());
  const Drawn picture = drawn(world, {}, true, 1, kTolerance_de00);
  const std::vector<double>& missed = picture.frame.maps.errors_de00;
  ASSERT_GT(missed.size(), 200U);
  const CorrectionNoise& rays = picture.frame.rays;
  EXPECT_TRUE(rays.reached);
  EXPECT_LE(rays.error_de00_p95, kTolerance_de00);
  EXPECT_GE(rays.error_de00_p95, rays.de00_p95);
  EXPECT_GT(rays.error_de00_p95, 0.5 * kTolerance_de00);
  Frame open = picture.frame;
  open.centers = open.open_centers;
  const PictureError exact = picture_error(open, world.scene, &world.sky, 1, 400, 3);
  EXPECT_GE(1.3 * percentile_95(missed), exact.p95_range.low);
  EXPECT_LE(0.75 * percentile_95(missed), exact.p95_range.high);
  // Control: without image light at hand nothing is measured.
  EXPECT_TRUE(drawn(world, {}, false).frame.maps.errors_de00.empty());
}

// The mean over the samples of a pixel is that of one sample, apart from edges and noise.
TEST(RayEffects, SeveralSamplesAreCorrectedEach) {
  const World world(ball_in_a_cup());
  const Drawn one = drawn(world, {Start::kAll}, true, 1), four = drawn(world, {Start::kAll}, true, 4);
  double sum_one = 0, sum_four = 0, least = 1;
  for (std::size_t i = 0; i < one.frame.picture.data.size(); i += 4) {
    sum_one += one.frame.picture.data[i], sum_four += four.frame.picture.data[i];
    least = std::min<double>(least, four.frame.picture.data[i]);
  }
  EXPECT_NEAR(sum_four, sum_one, 0.01 * sum_one);
  EXPECT_GT(least, -0.02);
}

// A picture of bands shows what a smaller one shows as a whole, at their seams as elsewhere.
TEST(RayEffects, BandsHaveNoSeams) {
  World world(ball_in_a_cup());
  constexpr int kSmall = 370;
  world.view = {Camera::orbit(world.mesh, 30, 60, 0.5, 30, 1), kSmall, kSmall};
  const Drawn small = drawn(world, {}, true, 1, 4);
  world.view.width = world.view.height = 2 * kSmall;
  const Drawn large = drawn(world, {}, true, 1, 4);
  const std::vector<Band> bands = bands_of(*large.frame.gbuffer, 1, true);
  ASSERT_EQ(bands.size(), 2U);
  EXPECT_TRUE(large.frame.rays.reached);
  double at_seam = 0, elsewhere = 0;
  int seams = 0, others = 0;
  for (int y = 0; y < kSmall; ++y) {
    for (int x = 0; x < kSmall; ++x) {
      color::Rgb mean, whole;
      for (int c = 0; c < 3; ++c) {
        for (int k = 0; k < 4; ++k) mean[c] += 0.25 * large.frame.picture.pixel(2 * x + k % 2, 2 * y + k / 2)[c];
        whole[c] = small.frame.picture.pixel(x, y)[c];
      }
      const bool near = std::abs(2 * y - bands[0].last_kept) <= 8;
      (near ? at_seam : elsewhere) += seen_difference(mean, whole, 1), ++(near ? seams : others);
    }
  }
  EXPECT_LT(at_seam / seams, 1.5 * elsewhere / others);
  EXPECT_LT(elsewhere / others, 1);
}

TEST(RayEffects, SelfAndBounceNeedShadow) {
  const World world(ball_in_a_cup());
  const Plan forced = drawn(world, {Start::kNone, {{"bounce", true}}}, true, 1, 20).plan;
  EXPECT_EQ(item(forced, "shadow").decision, Decision::kForcedOn);
  EXPECT_EQ(item(forced, "bounce").decision, Decision::kForcedOn);
  EXPECT_EQ(item(forced, "self").decision, Decision::kDropped);
  EXPECT_EQ(forced.effects.rays, (RayEffects{true, false, true}));
}

// A black ball of radius 1 that rests on the floor of an even sky. From the floor at the distance d from its center it
// hides the share 1/d^3 of the light, by the cosine: (R/d)^2 cos t with cos t = R/d.
TEST(RayEffects, AFloorIsDrawnAndShadedByEnginesWithMaps) {
  World world(sphere_mesh(64));
  world.scene.paints.assign(1, matt({0, 0, 0}));
  world.scene.background = Background::kEnvironment;
  world.env.mirror = world.env.diffuse;
  Ground ground;
  ground.height = -1, ground.probe_eye = {0, 0.5, 0};
  for (const char* engine : {"cpu", "gl"}) {
    for (const int samples : {1, 4}) {
      auto renderer = Renderer::create();
      ASSERT_TRUE(renderer.ok());
      RaySetup setup;
      setup.environment = &world.sky, setup.floor = ground;
      renderer->set_rays(setup);
      View view = world.view;
      view.width = view.height = 64, view.samples = samples, view.with_centers = false;
      const auto seen = renderer->look(world.mesh, view);
      ASSERT_TRUE(seen.ok());
      PlanRequest request;
      request.engine = engine, request.samples = samples, request.tolerance_de00 = 1;
      request.effects = {Start::kAuto, {{"rays", true}}};
      const auto plan = renderer->load(world.scene, {*seen}, request);
      ASSERT_TRUE(plan.ok()) << plan.error().message;
      EXPECT_TRUE(plan->effects.rays.floor);
      EXPECT_EQ(plan->items.back().effect, "floor");
      EXPECT_TRUE(plan->items.back().on);
      Frame frame;
      ASSERT_TRUE(renderer->draw(view, frame).ok());
      std::vector<double> errors, without;
      double bias = 0;
      for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
          const float* pixel = frame.picture.pixel(x, y);
          EXPECT_EQ(pixel[3], 1);
          // Pixels in whose neighborhood nothing but the floor is seen.
          bool floor = true;
          for (int j = std::max(0, y - 1); j <= std::min(63, y + 1); ++j)
            for (int i = std::max(0, x - 1); i <= std::min(63, x + 1); ++i)
              floor = floor && (*seen)->part(i, j) < 0 && (*seen)->to_viewer(i, j).y > 0.02;
          if (!floor) continue;
          const Vec3 toward = -(*seen)->to_viewer(x, y), eye = (*seen)->rays.eye;
          const Vec3 at = eye + ((-1 - eye.y) / toward.y) * toward;
          const double d = length(at);
          const double truth = 1 - 1 / (d * d * d);
          errors.push_back(seen_difference({pixel[0], pixel[1], pixel[2]}, {truth, truth, truth}, 1));
          without.push_back(seen_difference({1, 1, 1}, {truth, truth, truth}, 1));
          bias += pixel[1] - truth;
        }
      }
      ASSERT_GT(errors.size(), 300U);
      // The noise is one standard deviation at 95 of 100 points, so that 95 of 100 errors are within two of them. The
      // mesh is a polyhedron, which hides 0.3 % less than the ball.
      EXPECT_LE(frame.rays.de00_p95, 0.5);
      EXPECT_LT(percentile_95(errors), 2 * 0.5 + 0.1) << engine << ", " << samples;
      EXPECT_LT(std::abs(bias) / static_cast<double>(errors.size()), 0.004);
      EXPECT_GT(percentile_95(without), 5) << "the control: the floor in the open";
    }
  }
}

// Without a floor to be drawn nothing is, and forced off it is not drawn either.
TEST(RayEffects, AFloorNeedsShadow) {
  World world(ball_in_a_cup());
  world.scene.background = Background::kEnvironment;
  world.env.mirror = world.env.diffuse;
  auto renderer = Renderer::create();
  ASSERT_TRUE(renderer.ok());
  RaySetup setup;
  setup.environment = &world.sky;
  setup.floor.emplace();
  setup.floor->height = -1;
  renderer->set_rays(setup);
  const auto seen = renderer->look(world.mesh, world.view);
  ASSERT_TRUE(seen.ok());
  PlanRequest request;
  request.effects = {Start::kAuto, {{"shadow", false}}};
  const auto plan = renderer->load(world.scene, {*seen}, request);
  ASSERT_TRUE(plan.ok());
  EXPECT_FALSE(plan->effects.rays.floor);
  EXPECT_FALSE(plan->effects.rays.any());
  request.effects = {};
  const auto with = renderer->load(world.scene, {*seen}, request);
  ASSERT_TRUE(with.ok());
  EXPECT_TRUE(with->effects.rays.floor);
}

}  // namespace
}  // namespace goniochrome::render::ray_effects_test
