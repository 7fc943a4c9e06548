#include "render/panes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/angles.h"
#include "brdf/lobe_model.h"
#include "render/path/scenes_for_paths_for_test.h"
#include "render/renderer.h"
#include "render/scene_effects.h"

namespace goniochrome::render::panes_test {
namespace {

void add_square(const std::string& name, double z, double half, mesh::Mesh& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const auto& [x, y] : {std::pair{-half, -half}, {half, -half}, {half, half}, {-half, half}}) {
    mesh.positions.push_back({x, y, z});
    mesh.normals.push_back({0, 0, 1});
  }
  mesh.parts.push_back({name, "", mesh.triangles.size(), 2});
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

// A wall behind two panes that are larger, so that the background is seen through them too.
struct Shop {
  mesh::Mesh mesh;
  envmap::PrefilteredEnvironment env = constant_env({1, 1, 1}, {20});
  envmap::Environment sky = even_environment();
  envmap::BlockTree texels{sky};
  Scene scene;
  View view;

  explicit Shop(double albedo = 1, Background background = Background::kEnvironment) {
    add_square("wall", 0, 0.5, mesh);
    add_square("near pane", 0.6, 0.8, mesh);
    add_square("far pane", 0.3, 0.8, mesh);
    scene.mesh = &mesh, scene.env = &env, scene.texels = &texels, scene.background = background;
    scene.paints = {matt({albedo, albedo, albedo}), pane_finish(), pane_finish()};
    scene.panes = {false, true, true};
    view = {Camera::orbit(mesh, 25, 20, 1, 30, 1), 40, 40, 1, false};
  }
  Shop(const Shop&) = delete;

  Frame drawn(const std::string& engine) const {
    auto renderer = engine == "path" ? Result<Renderer>(Renderer::tracing()) : Renderer::create();
    EXPECT_TRUE(renderer.ok());
    const auto loaded = renderer->load(scene, engine);
    EXPECT_TRUE(loaded.ok()) << loaded.error().message;
    Frame frame;
    EXPECT_TRUE(renderer->draw(view, frame).ok());
    return frame;
  }
};

double largest_error(const Frame& frame, double wanted) {
  double error = 0;
  for (int y = 0; y < frame.picture.height; ++y)
    for (int x = 0; x < frame.picture.width; ++x)
      for (int c = 0; c < 3; ++c)
        error = std::max(error, std::abs(static_cast<double>(frame.picture.pixel(x, y)[c]) - wanted));
  return error;
}

// Against the sum of the reflections between the two faces, and the known value 2 R/(1 + R) along the normal.
TEST(Panes, ReflectWhatBothFacesDoTogether) {
  EXPECT_NEAR(pane_reflectance(1), 0.08 / 1.04, 1e-12);
  EXPECT_NEAR(pane_reflectance(0), 1, 1e-12);
  for (int view = 0; view < 90; view += 3) {
    const double cosine = std::cos(view * kDegree), f = brdf::fresnel_dielectric(cosine, brdf::kCoatIndex);
    double reflected = f, passed = 0, inside = 1 - f;
    for (int i = 0; i < 4000; ++i) {
      (i % 2 == 0 ? passed : reflected) += (1 - f) * inside;
      inside *= f;
    }
    EXPECT_NEAR(pane_reflectance(cosine), reflected, 1e-9) << view;
    EXPECT_NEAR(1 - pane_reflectance(cosine), passed, 1e-9) << view;
  }
}

// Engines draw that reflectance. Control: a single face, which a coat mirrors.
TEST(Panes, AreDrawnWithThatReflectance) {
  const paint::LobeFit finish = pane_finish();
  double apart = 0, of_face = 0;
  for (double view = 0; view < 90; view += 0.1) {
    const double cosine = std::cos(view * kDegree), f = brdf::fresnel_dielectric(cosine, brdf::kCoatIndex);
    const paint::LobeFit here = brdf::at_view(finish, view);
    apart = std::max(apart, std::abs(f * here.lobes.front().gloss.x - pane_reflectance(cosine)));
    of_face = std::max(of_face, std::abs(f - pane_reflectance(cosine)));
  }
  EXPECT_LT(apart, 3e-4);
  EXPECT_GT(of_face, 0.1);
}

// In light that is 1 from everywhere, a white wall behind clear panes shows 1, as do the panes and the background:
// reflected and transmitted light are 1 together. Engines of maps draw weights by straight pieces, to 5e-4; paths have
// noise of .01 in 1600 pixels, whose mean is 1 to 1e-3 at four standard deviations. Control: panes that mirror as one
// face does lose what the others send back.
TEST(Panes, NeitherMakeNorLoseLight) {
  const Shop shop;
  EXPECT_LT(largest_error(shop.drawn("cpu"), 1), 5e-4);
  EXPECT_LT(largest_error(shop.drawn("integral"), 1), 2e-3);
  const Frame path = shop.drawn("path");
  double mean = 0;
  for (std::size_t i = 0; i < path.picture.data.size(); i += 4)
    mean += static_cast<double>(path.picture.data[i]) / static_cast<double>(path.picture.data.size() / 4);
  EXPECT_NEAR(mean, 1, 1e-3);
  Shop textbook;
  textbook.scene.paints[1] = textbook.scene.paints[2] = only_mirror();
  for (const char* engine : {"cpu", "path"}) EXPECT_GT(largest_error(textbook.drawn(engine), 1), 0.05) << engine;
}

// Beside the wall nothing but two panes covers a pixel; before the wall all is covered. Control: without the effect
// the panes cover what they hide.
TEST(Panes, CoverWhatTheyDoNotLetThrough) {
  const Shop shop(0.5, Background::kNone);
  const Frame cpu = shop.drawn("cpu"), path = shop.drawn("path");
  const Rays rays = *goniochrome::render::rays(shop.view.camera, shop.view.width, shop.view.height);
  int through = 0, before_wall = 0;
  for (int y = 0; y < shop.view.height; ++y) {
    for (int x = 0; x < shop.view.width; ++x) {
      if (cpu.gbuffer->part(x, y) < 1) continue;
      const Vec3 d = rays.direction(x + 0.5, y + 0.5), at = rays.eye + (-rays.eye.z / d.z) * d,
                 far = rays.eye + ((0.3 - rays.eye.z) / d.z) * d, near = rays.eye + ((0.6 - rays.eye.z) / d.z) * d;
      const double passed = 1 - pane_reflectance(std::abs(d.z));
      const auto margin = [](const Vec3& p, double half) { return half - std::max(std::abs(p.x), std::abs(p.y)); };
      const bool wall = margin(at, 0.5) > 0.02, beside = margin(at, 0.5) < -0.02 && margin(far, 0.8) > 0.02;
      if (margin(near, 0.8) < 0.02) continue;
      if (!wall && !beside) continue;
      ++(wall ? before_wall : through);
      const double wanted = wall ? 1 : 1 - passed * passed;
      EXPECT_NEAR(cpu.picture.pixel(x, y)[3], wanted, 1e-5);
      EXPECT_NEAR(path.picture.pixel(x, y)[3], wanted, 1e-5);
      if (!wall) continue;
      EXPECT_NEAR(cpu.picture.pixel(x, y)[0], 0.5 * passed * passed + 1 - passed * passed, 1e-3);
    }
  }
  EXPECT_GT(through, 50);
  EXPECT_GT(before_wall, 100);
  auto renderer = Renderer::create();
  Effects effects = effects_of(shop.scene);
  effects.panes = false;
  ASSERT_TRUE(renderer.ok() && renderer->load(shop.scene, effects, "cpu").ok());
  Frame without;
  ASSERT_TRUE(renderer->draw(shop.view, without).ok());
  EXPECT_EQ(without.picture.pixel(20, 20)[3], 1);
  EXPECT_LT(without.picture.pixel(20, 20)[0], 0.2);
}

// Rays that bring light pass panes, so that these cast no shadow. Control: a wall in their place does.
TEST(Panes, LetLightPass) {
  const Shop shop;
  const auto passing = rays::RayScene::create(shop.mesh, {}, shop.scene.panes),
             whole = rays::RayScene::create(shop.mesh);
  ASSERT_TRUE(passing.ok() && whole.ok());
  const Vec3 from{0.1, 0.1, 1}, toward{0, 0, -1};
  const auto met_part = [&](const rays::RayScene& scene) {
    return scene.part(scene.closest(scene.local(from), rays::float3(toward)).triangle);
  };
  EXPECT_EQ(met_part(*whole), 1);
  EXPECT_EQ(met_part(*passing), 0);
  EXPECT_FALSE(passing->occluded(passing->local({0.1, 0.1, 0.1}), {0, 0, 1}));
  EXPECT_TRUE(whole->occluded(whole->local({0.1, 0.1, 0.1}), {0, 0, 1}));
  // Its spots are known nevertheless.
  const rays::Spot spot = passing->spot({2, 0.25F, 0.25F, 0}, passing->local(from), rays::float3(toward));
  EXPECT_EQ(spot.part, 1);
  EXPECT_NEAR(passing->world(spot.position).z, 0.6, 1e-6);
}

// With the effects of rays, the engine cpu draws behind panes what paths find there.
TEST(Panes, ShowTheShadowsBehindThem) {
  Shop shop(0.8);
  add_square("shelf", 0.15, 0.4, shop.mesh);
  for (std::size_t i = shop.mesh.positions.size() - 4; i < shop.mesh.positions.size(); ++i) {
    Vec3& p = shop.mesh.positions[i];
    p = {p.x, 0, p.z + 0.3 * p.y};  // level, above the lower half of the wall
    shop.mesh.normals[i] = {0, 1, 0};
  }
  shop.scene.paints.push_back(matt({0.1, 0.1, 0.1})), shop.scene.panes.push_back(false);
  const Frame path = shop.drawn("path");
  const auto by_cpu = [&](bool with_rays) {
    auto renderer = Renderer::create();
    EXPECT_TRUE(renderer.ok());
    RaySetup setup;
    setup.environment = &shop.sky;
    renderer->set_rays(setup);
    const auto seen = renderer->look(shop.mesh, shop.view);
    PlanRequest request;
    request.effects = *words_of(with_rays ? "all" : "all,-rays"), request.engine = "cpu";
    const auto plan = renderer->load(shop.scene, {*seen}, request);
    EXPECT_TRUE(plan.ok()) << plan.error().message;
    const auto& item = *std::ranges::find(plan->items, "panes", &PlanItem::effect);
    EXPECT_TRUE(item.needed && item.on);
    Frame frame;
    EXPECT_TRUE(renderer->draw(shop.view, frame).ok());
    return frame;
  };
  const auto mean_apart = [&](const Frame& frame) {
    double sum = 0;
    for (std::size_t i = 0; i < frame.picture.data.size(); i += 4)
      sum += std::abs(frame.picture.data[i] - path.picture.data[i]);
    return sum / static_cast<double>(frame.picture.data.size() / 4);
  };
  // Means over the picture, in which the noise of both is half a unit of dE00, 6e-3 of white, at the worst points.
  const double with_rays = mean_apart(by_cpu(true)), without = mean_apart(by_cpu(false));
  EXPECT_LT(with_rays, 6e-3) << without;
  EXPECT_GT(without, 2 * with_rays) << with_rays;
}

TEST(Panes, AreRefusedByNameWhereTheyCannotBeDrawn) {
  const Shop shop;
  auto renderer = Renderer::create();
  ASSERT_TRUE(renderer.ok());
  const auto by_gl = renderer->load(shop.scene, "gl");
  ASSERT_FALSE(by_gl.ok());
  EXPECT_NE(by_gl.error().message.find("engine gl does not draw what lies behind panes"), std::string::npos);
  const auto seen = renderer->look(shop.mesh, shop.view);
  ASSERT_TRUE(seen.ok());
  const auto given = Renderer::shading(*seen).load(shop.scene, "cpu");
  ASSERT_FALSE(given.ok());
  EXPECT_NE(given.error().message.find("where the mesh is there"), std::string::npos);
}

// A scene without panes is loaded and drawn as before: no second tree, no behind, no effect.
TEST(Panes, CostNothingWhereThereAreNone) {
  Shop shop;
  shop.scene.panes = {false, false, false};
  EXPECT_FALSE(has_panes(shop.scene));
  EXPECT_FALSE(effects_of(shop.scene).panes);
  auto renderer = Renderer::create();
  const auto seen = renderer->look(shop.mesh, shop.view);
  const auto whole = rays::RayScene::create(shop.mesh);
  EXPECT_TRUE(behind_panes(*whole, shop.scene, **seen).empty());
}

}  // namespace
}  // namespace goniochrome::render::panes_test
