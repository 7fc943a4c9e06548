// Properties of every engine that is registered, by its name alone.
#include "render/engine.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "render/cpu/cpu_engine.h"
#include "render/picture_error.h"
#include "render/renderer.h"
#include "render/scene_effects.h"
#include "render/scenes_for_test.h"

namespace goniochrome::render::engine_test {
namespace {

using testing::HasSubstr;

// A sphere in flakes and gloss, under even light and a lamp.
struct World {
  mesh::Mesh mesh = sphere_mesh(48);
  envmap::PrefilteredEnvironment env = constant_env({1, 0.9, 0.8}, {6, 40});
  envmap::Environment source = *envmap::Environment::from_lat_long(
      [] {
        image::Image image{32, 16, 3, {}, {}};
        for (int i = 0; i < 32 * 16; ++i)
          for (const float value : {1.0F, 0.9F, 0.8F}) image.data.push_back(value);
        return image;
      }(),
      envmap::Environment::BadPixels::kError, "even");
  envmap::BlockTree blocks{source};
  Scene scene;
  View view{Camera::orbit(mesh, 30, 20, 1, 30, 1), 40, 40, 1, false};

  World() {
    paint::LobeFit paint = matt({0.1, 0.2, 0.05});
    paint.lobes = {{6, {0.05, 0.1, 0.02}, {}}, {40, {0.2, 0.3, 0.1}, {0.1, 0.1, 0.1}}};
    scene.mesh = &mesh, scene.env = &env, scene.texels = &blocks, scene.paints = {paint};
    scene.lights = {{normalized({1, 2, 3}), {1, 0.9, 0.8}}};
  }
};

TEST(Engines, HaveNamesOfTheirOwnAndASentence) {
  std::set<std::string> names = {"auto"};
  for (const EngineInfo* engine : engines()) {
    EXPECT_TRUE(names.insert(engine->name).second) << engine->name;
    EXPECT_GT(std::string(engine->sentence).size(), 20U) << engine->name;
    EXPECT_EQ(*engine_named(engine->name), engine);
  }
  EXPECT_EQ(engine_choices().size(), engines().size() + 1);
  EXPECT_EQ(engine_choices().front(), "auto");
  EXPECT_THAT(engine_named("vulkan").error().message, HasSubstr("there is no engine \"vulkan\": there are cpu, gl"));
}

TEST(WeightTable, PartsInARowThatWearTheSameShareARow) {
  World world;
  const paint::LobeFit one = world.scene.paints.front(), other = matt({0.5, 0.1, 0.1});
  world.scene.paints = {one, one, other, other, one};
  const Effects effects = effects_of(world.scene);
  const WeightTable table = weight_table(world.scene, effects);
  EXPECT_EQ(table.rows, (std::vector<int>{0, 0, 1, 1, 2}));
  EXPECT_EQ(table.rgba.size(), 3 * table.row_floats());
  for (std::size_t part = 0; part < table.rows.size(); ++part) {
    Scene alone = world.scene;
    alone.paints = {world.scene.paints[part]};
    const WeightTable own = weight_table(alone, effects);
    EXPECT_TRUE(std::equal(own.rgba.begin(), own.rgba.end(), table.at(table.rows[part], 0, 0))) << part;
  }
}

// The closed form is what the reference integrates: even light leaves each engine its own approximation of the horizon,
// which is some tenths. Twice the light is the control.
TEST(Engines, DrawTheSceneThatTheReferenceIntegrates) {
  const World world;
  for (const EngineInfo* engine : engines()) {
    auto renderer = Renderer::create();
    ASSERT_TRUE(renderer.ok());
    ASSERT_TRUE(renderer->load(world.scene, engine->name).ok()) << engine->name;
    View view = world.view;
    view.with_centers = true;
    Frame frame;
    ASSERT_TRUE(renderer->draw(view, frame).ok()) << engine->name;
    EXPECT_LT(picture_error(frame, world.scene, &world.source, 1, 60, 3).de00_p95, 0.5) << engine->name;
    for (float& value : frame.centers.data) value *= 2;
    EXPECT_GT(picture_error(frame, world.scene, &world.source, 1, 60, 3).de00_p95, 5) << engine->name;
  }
}

// Engines that need no mesh shade a G-buffer alone. The processor gives single points the colors of their pixels.
TEST(Engines, ShadeBuffersAndPointsAlike) {
  struct Nowhere : Sight {
    std::shared_ptr<const Gbuffer> seen;
    std::vector<TexturePlace> none;
    std::shared_ptr<const Gbuffer> gbuffer(int) override { return seen; }
    const std::vector<TexturePlace>& places(int) override { return none; }
    const GlContext* gl() const override { return nullptr; }
  } sight;
  const World world;
  sight.seen = std::make_shared<const Gbuffer>(seen_by_rays(world.mesh, world.view.camera, 40, 40));
  int able = 0;
  for (const EngineInfo* info : engines()) {
    const auto engine = info->make(sight);
    EXPECT_EQ(&engine->info(), info);
    EXPECT_EQ(engine->can_shade(world.scene).ok(), !info->needs_mesh) << info->name;
    if (info->needs_mesh) continue;
    ASSERT_TRUE(engine->load(world.scene, effects_of(world.scene)).ok());
    image::Image picture;
    ASSERT_TRUE(engine->shade(sight, 0, 1, false, picture).ok());
    engine->finish(picture);
    EXPECT_GT(picture.pixel(20, 20)[0], 0) << info->name;
    ++able;
    const auto* cpu = dynamic_cast<const CpuEngine*>(engine.get());
    if (cpu == nullptr) continue;
    const color::Rgb color = cpu->colors({sight.seen->point(20, 20)}).front();
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(color[c], picture.pixel(20, 20)[c], 1e-6);
  }
  EXPECT_GE(able, 2);
}

// A third paint meets the light that the first one met, on smooth and on brushed parts, under point lamps and discs.
// Another engine has the same colors by maps that it shares.
TEST(Engines, ShadePointsInSeveralPaintsAsInEach) {
  World world;
  const envmap::PrefilteredEnvironment uneven = uneven_env({1.3, 6, 40}, {8, 16, 32});
  Scene& scene = world.scene;
  scene.env = &uneven;
  paint::LobeFit wide = matt({0.1, 0.2, 0.05}), glossy = matt({0, 0, 0});
  wide.lobes = {{1.3, {0.3, 0.1, 0.02}, {}}};
  glossy.lobes = {{1.3, {}, {0.1, 0.1, 0.1}}, {6, {}, {0.04, 0.03, 0.02}}};
  scene.paints.insert(scene.paints.end(), {wide, glossy});
  const Gbuffer buffer = seen_by_rays(world.mesh, world.view.camera, 24, 24);
  std::vector<VisiblePoint> seen;
  for_seen(buffer, [&](int x, int y, int) { seen.push_back(buffer.point(x, y)); });
  ASSERT_GT(seen.size(), 64U);
  for (const bool brushed : {false, true})
    for (const double radius_rad : {0.0, 0.1}) {
      scene.lights.front().radius_rad = radius_rad;
      scene.anisotropy.assign(3, brushed ? paint::Anisotropy{0.05, 0.3} : paint::Anisotropy{});
      CpuEngine engine, other;
      ASSERT_TRUE(engine.load(scene, effects_of(scene)).ok());
      const std::vector<color::Rgb> together = engine.colors(seen, 3);
      other.share_maps(engine);
      ASSERT_TRUE(other.load(scene, effects_of(scene)).ok());
      ASSERT_EQ(together.size(), 3 * seen.size());
      for (std::size_t paint = 0; paint < 3; ++paint) {
        std::vector<VisiblePoint> points = seen;
        for (VisiblePoint& point : points) point.part = static_cast<int>(paint);
        const std::vector<color::Rgb> alone = engine.colors(points);
        for (std::size_t i = 0; i < seen.size(); ++i)
          EXPECT_LT(length(together[paint * seen.size() + i] - alone[i]), 1e-6) << brushed << radius_rad;
        EXPECT_EQ(other.colors(points), alone);
        EXPECT_EQ(alone == engine.colors(seen), paint == 0);
      }
    }
}

}  // namespace
}  // namespace goniochrome::render::engine_test
