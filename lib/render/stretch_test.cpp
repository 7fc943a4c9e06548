// Rough coats in prefiltered maps: lobes along the plane of incidence beside the integral of the facets, and in plans.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/angles.h"
#include "base/testdata_for_test.h"
#include "brdf/gloss.h"
#include "brdf/rough_coat.h"
#include "envmap/environment.h"
#include "prefilter/prefilter.h"
#include "render/exact.h"
#include "render/internal/tilt_table.h"
#include "render/picture_error.h"
#include "render/plan.h"
#include "render/renderer.h"
#include "render/scene_effects.h"
#include "render/scenes_for_test.h"

namespace goniochrome::render::stretch_test {
namespace {

const std::vector<double> kBasis = {1.3, 6, 20, 70, 250, 900, 3000};

// A dark paint with the gloss of a coat.
paint::LobeFit satin(const brdf::RoughCoat& coat) {
  const brdf::GlossTable table(kBasis);
  paint::LobeFit fit;
  fit.coat_index = 1.5;
  fit.diffuse = (1 / kPi) * color::Rgb{0.02, 0.03, 0.07};
  for (const double e : kBasis) fit.lobes.push_back({e, {}, {}});
  fit.lobes.push_back({paint::kMirrorExponent, {}, {}});
  std::vector<paint::GlossReading> readings;
  for (const double angle : brdf::kGlossAngles_deg)
    readings.push_back(
        {angle, *brdf::coat_reading(coat, angle, 1.5) + brdf::gloss_units(table, **table.at(angle), fit)});
  EXPECT_TRUE(brdf::set_gloss(table, readings, fit).ok());
  EXPECT_TRUE(brdf::set_gloss_views(table, readings, fit).ok());
  return fit;
}

// A sphere under one light.
struct World {
  explicit World(const char* file)
      : source(*envmap::Environment::read(testdata(file), envmap::Environment::BadPixels::kZero)) {
    prefilter::PrefilterRequest request;
    request.exponents = kBasis, request.mirror = true;
    env =
        prefilter::prefiltered(source, request, prefilter::prefilter_plan(source, request), [](const auto&, double) {});
    scene.mesh = &mesh, scene.env = &env, scene.gloss_deg = {20};
  }
  void wear(const paint::LobeFit& paint) { scene.paints = {paint}; }
  Frame drawn(const Effects& effects, const std::string& engine) const {
    auto renderer = Renderer::create();
    const auto loaded = renderer->load(scene, effects, engine);
    EXPECT_TRUE(loaded.ok()) << (loaded.ok() ? "" : loaded.error().message);
    return *renderer->draw(Camera::orbit(mesh, 30, 20, 1, 30, 1), 64, 64, 1, true);
  }
  PictureError error(bool stretch) const {
    Effects effects = effects_of(scene);
    EXPECT_TRUE(effects.stretch && effects.satin);
    effects.stretch = stretch;
    return picture_error(drawn(effects, "cpu"), scene, {blocks, 0.1}, white, 150, 3);
  }

  envmap::Environment source;
  envmap::BlockTree blocks{source};
  mesh::Mesh mesh = sphere_mesh(96);
  envmap::PrefilteredEnvironment env;
  Scene scene;
  double white = 1;
};

const brdf::RoughCoat kCoats[] = {{0, 0.04}, {0, 0.2, 0.3, brdf::Slopes::kGaussian}, {2.1, 0.011, 0.4}};

// The control is the lobes about the mirror direction alone.
TEST(Stretch, ClosesInOnTheFacets) {
  for (const char* file : {"studio.exr", "outdoor.exr"}) {
    World world(file);
    for (const brdf::RoughCoat& coat : kCoats) {
      world.wear(satin(coat));
      const PictureError round = world.error(false), stretched = world.error(true);
      std::printf("%s k %.1f a %.3f: round %.2f (%.2f), stretched %.2f (%.2f)\n", file, coat.k, coat.slope,
                  round.de00_p95, round.de00_mean, stretched.de00_p95, stretched.de00_mean);
      EXPECT_LE(stretched.de00_p95, 0.6 * round.de00_p95);
      EXPECT_LE(stretched.de00_mean, 0.65 * round.de00_mean);
    }
  }
}

// The plan tries out the look-ups, and leaves them out where nothing is asked of them.
TEST(Stretch, IsPlanned) {
  World world("studio.exr");
  world.wear(satin(kCoats[1]));
  auto renderer = Renderer::create();
  const Camera camera = Camera::orbit(world.mesh, 30, 20, 1, 30, 1);
  const auto gbuffer = renderer->look(world.mesh, {camera, 128, 128, 1, false});
  ASSERT_TRUE(gbuffer.ok());
  const auto item = [](const Plan& plan, const std::string& name) {
    return *std::ranges::find(plan.items, name, &PlanItem::effect);
  };
  const auto planned = [&](PlanRequest request) { return *renderer->load(world.scene, {*gbuffer}, request); };
  const Plan plan = planned({});
  EXPECT_TRUE(item(plan, "stretch").on);
  EXPECT_TRUE(plan.effects.stretch);
  EXPECT_GT(item(plan, "stretch").de00_p95, 0.5);
  PlanRequest loose;
  loose.tolerance_de00 = 200;  // no highlight changes by more
  EXPECT_FALSE(planned(loose).effects.stretch);
  world.scene.lights.push_back({{0, 0, 1}, {1, 1, 1}});
  EXPECT_FALSE(effects_of(world.scene).stretch);
  world.scene.lights.clear();
  world.scene.env = nullptr;
  EXPECT_FALSE(effects_of(world.scene).stretch);
}

}  // namespace
}  // namespace goniochrome::render::stretch_test
