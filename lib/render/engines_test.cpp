// The two engines against each other, and what the weights hold against the integrals they stand for.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/angles.h"
#include "brdf/lobe_model.h"
#include "color/color.h"
#include "render/renderer.h"
#include "render/scene_effects.h"
#include "render/scenes_for_test.h"

namespace goniochrome::render::engines_test {
namespace {

color::Lab lab_of(const float* pixel) {
  return color::lab_from_xyz(color::xyz_d65_from_rgb({pixel[0], pixel[1], pixel[2]}),
                             color::xyz_d65_from_rgb({1, 1, 1}));
}

// Draws with both engines and returns the largest dE00 of any pixel.
double disagreement(const Scene& scene, const Effects& effects, int samples) {
  Frame frames[2], *frame = frames;
  for (const char* engine : {"gl", "cpu"}) {
    auto renderer = Renderer::create();
    EXPECT_TRUE(renderer.ok());
    const auto loaded = renderer->load(scene, effects, engine);
    EXPECT_TRUE(loaded.ok()) << loaded.error().message;
    const View view{Camera::orbit(*scene.mesh, 30, 20, 0.9, 30, 1.5), 120, 80, samples, false};
    EXPECT_TRUE(renderer->draw(view, *frame++).ok());
  }
  double worst = 0, alpha = 0;
  for (int y = 0; y < 80; ++y) {
    for (int x = 0; x < 120; ++x) {
      const float *gl = frames[0].picture.pixel(x, y), *cpu = frames[1].picture.pixel(x, y);
      worst = std::max(worst, color::delta_e_2000(lab_of(gl), lab_of(cpu)));
      EXPECT_NEAR(gl[3], cpu[3], 1e-6);
      alpha = std::max<double>(alpha, gl[3]);
    }
  }
  EXPECT_EQ(alpha, 1) << "the mesh is in the picture";
  return worst;
}

// Single precision in another order: a few 1e-6 of the value, and of a lobe of exponent E that many times E/1000.
constexpr double kAgreed = 0.05;

TEST(Engines, AgreeOnEveryEffectAlone) {
  const mesh::Mesh mesh = sphere_mesh(96);
  const std::vector<double> exponents = {1.3, 6, 40, 300, 3000};
  const envmap::PrefilteredEnvironment env = uneven_env(exponents, {32, 20, 44, 100, 64});
  const std::vector<Light> lights = {{normalized({1, 2, 3}), {1, 1, 1}}, {normalized({-3, -1, 2.5}), {0.4, 0.1, 0.6}}};
  Scene scene{&mesh, {rich_paint()}, &env, lights, Background::kNone, {}};
  const Effects all = effects_of(scene);
  Effects none;
  none.environment = true, none.diffuse = false;
  scene.anisotropy = {{0.05, 0.3}};
  scene.reflection = color::working_space_operator();
  std::vector<Effects> cases(13, none);
  cases[0].diffuse = true;
  cases[1].lobes = {{1.3, true, false}};
  cases[2].lobes = all.lobes;
  cases[3].lobes = all.lobes, cases[3].fresnel = true;
  cases[4].lobes = all.lobes, cases[4].horizon = true;
  cases[5].mirror = true;
  cases[6].mirror = cases[6].fresnel = true;
  cases[7].environment = false, cases[7].lights = 2, cases[7].lobes = all.lobes, cases[7].diffuse = true;
  cases[8] = all;
  cases[9].lobes = all.lobes, cases[9].anisotropy = true;
  cases[10] = cases[7], cases[10].anisotropy = cases[10].fresnel = true;
  cases[11] = all, cases[11].reflection = true;
  cases[12] = effects_of(scene);
  EXPECT_TRUE(cases[12].anisotropy && cases[12].reflection && cases[12].fresnel && cases[12].horizon);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    EXPECT_LT(disagreement(scene, cases[i], 1), kAgreed) << "case " << i;
  }
}

TEST(Engines, AgreeOnSamplesBackgroundsAndParts) {
  const mesh::Mesh mesh = panels_mesh(3);
  const envmap::PrefilteredEnvironment env = uneven_env({1.3, 6, 40, 300, 3000}, {32, 20, 44, 100, 64});
  Scene scene{&mesh, {rich_paint(), matt({1, 0.5, 0.2}), only_mirror()}, &env, {Light{}}, Background::kNone, {}};
  for (const Background background : {Background::kNone, Background::kColor, Background::kEnvironment}) {
    scene.background = background;
    scene.background_color = {0.1, 0.2, 0.4};
    for (const int samples : {1, 4, 16}) EXPECT_LT(disagreement(scene, effects_of(scene), samples), kAgreed);
  }
}

// A satin coat may have a lobe at one view that it has at no other, and not among the weights for all views. Under a
// lamp each point of a ball shows pi f cos times the lamp's white, by the weights of its view.
TEST(Engines, DrawLobesThatStandInAViewAlone) {
  const mesh::Mesh mesh = sphere_mesh(96);
  paint::LobeFit satin;
  satin.diffuse = {0.05, 0.04, 0.03};
  satin.lobes = {{12, {}, {0.05, 0.05, 0.05}}};
  satin.views = {{0, satin.diffuse, satin.lobes},
                 {70, satin.diffuse, {{12, {}, {0.05, 0.05, 0.05}}, {80, {0.1, 0.2, 0.3}, {4, 4, 4}}}}};
  const Light lamp{normalized({2, 0.4, -0.5}), {1, 0.9, 0.8}};
  Scene scene{&mesh, {satin}, nullptr, {lamp}, Background::kNone, {}};
  const Effects effects = effects_of(scene);
  ASSERT_EQ(effects.lobes.size(), 2U);
  for (const char* engine : {"gl", "cpu"}) {
    auto renderer = Renderer::create();
    ASSERT_TRUE(renderer.ok());
    const auto loaded = renderer->load(scene, effects, engine);
    ASSERT_TRUE(loaded.ok()) << loaded.error().message;
    Frame frame;
    ASSERT_TRUE(renderer->draw({Camera::orbit(mesh, 30, 20, 0.9, 30, 1.5), 120, 80, 1, true}, frame).ok());
    const Gbuffer& g = *frame.gbuffer;
    double worst = 0, control = 0;
    int lit = 0;
    for (int y = 0; y < g.height; ++y) {
      for (int x = 0; x < g.width; ++x) {
        if (g.part(x, y) < 0) continue;
        const Vec3 normal = normalized(g.normal(x, y)), viewer = g.to_viewer(x, y);
        const double cos_i = dot(normal, lamp.direction), cos_o = dot(normal, viewer);
        if (cos_i < 0.02 || cos_o < 0.1) continue;
        const auto truth = [&](const paint::LobeFit& paint) {
          const paint::LobeFit here = brdf::at_view(paint, std::acos(cos_o) / kDegree);
          return kPi * cos_i * (brdf::coated_brdf(here, lamp.direction, viewer, normal) * lamp.white);
        };
        paint::LobeFit without = satin;
        without.views.back().lobes.pop_back();
        const color::Rgb right = truth(satin), wrong = truth(without);
        const float* drawn = frame.picture.pixel(x, y);
        for (int c = 0; c < 3; ++c) {
          worst = std::max(worst, std::abs(drawn[c] - right[c]) / right[c]);
          control = std::max(control, std::abs(wrong[c] - right[c]) / right[c]);
        }
        ++lit;
      }
    }
    EXPECT_GT(lit, 500);
    // Weights by the view are tables along cos, straight between their nodes.
    EXPECT_LT(worst, 0.03) << engine;
    EXPECT_GT(control, 0.5) << "a lobe that is left out";
  }
}

// A common operator and one that no four squares make, with the environment behind the mesh.
TEST(Engines, AgreeOnEveryOperator) {
  const mesh::Mesh mesh = sphere_mesh(96);
  const envmap::PrefilteredEnvironment env = uneven_env({1.3, 6, 40, 300, 3000}, {32, 20, 44, 100, 64});
  Scene scene{&mesh, {rich_paint()}, &env, {{normalized({1, 2, 3}), {1, 0.5, 0.2}}}, Background::kEnvironment, {}};
  scene.anisotropy = {{0.05, 0.3}};
  for (const color::ReflectionOperator& op : {color::iso_rgb_operator(), five_form_operator()}) {
    scene.reflection = op;
    EXPECT_LT(disagreement(scene, effects_of(scene), 1), kAgreed);
    scene.anisotropy.clear();
    EXPECT_LT(disagreement(scene, effects_of(scene), 1), kAgreed);
  }
}

}  // namespace
}  // namespace goniochrome::render::engines_test
