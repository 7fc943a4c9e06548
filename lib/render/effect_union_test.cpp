#include "render/effect_union.h"

#include <gtest/gtest.h>

#include "render/engine.h"
#include "render/renderer.h"
#include "render/scene_effects.h"
#include "render/scenes_for_test.h"

namespace goniochrome::render::effect_union_test {
namespace {

paint::LobeFit paint_of(std::initializer_list<double> exponents, bool gloss) {
  paint::LobeFit paint;
  paint.diffuse = {0.1, 0.2, 0.05};
  for (const double exponent : exponents)
    paint.lobes.push_back({exponent, {0.02, 0.03, 0.1}, gloss ? color::Rgb{0.01, 0.01, 0.01} : color::Rgb{}});
  return paint;
}

class EffectUnion : public testing::Test {
 protected:
  Scene scene(const paint::LobeFit& paint) const {
    Scene scene;
    scene.mesh = &mesh_;
    scene.paints = {paint};
    scene.lights = {{{0.3, 0.4, 0.866}, {1, 1, 1}}};  // a point: a disc would be drawn as one for the other paint alone
    return scene;
  }
  mesh::Mesh mesh_ = sphere_mesh(64);
};

TEST_F(EffectUnion, CoversBothAndNeitherCoversTheOther) {
  paint::LobeFit coated = paint_of({900}, true);
  coated.coat_index = 1.5;
  const Effects a = effects_of(scene(paint_of({2, 20}, false))), b = effects_of(scene(coated));
  const Effects both = united(a, b);
  EXPECT_TRUE(covers(both, a) && covers(both, b));
  EXPECT_FALSE(covers(a, b) || covers(b, a));
  ASSERT_EQ(both.lobes.size(), 3u);
  EXPECT_TRUE(both.coat && both.fresnel);
  EXPECT_TRUE(covers(a, a));
}

// Effects for other paints change a picture by no more than rounding: sums of the same floats in another order, of up
// to 16 terms.
TEST_F(EffectUnion, ChangesNoPicture) {
  const paint::LobeFit plain = paint_of({2, 20}, false), glossy = paint_of({8, 900}, true);
  const Scene alone = scene(plain);
  const Effects both = united(effects_of(alone), effects_of(scene(glossy)));
  Camera camera;
  camera.eye = {0, 0, 8}, camera.fov_deg = 20;
  const auto drawn = [&](const Effects& effects) {
    Renderer renderer = Renderer::tracing();
    EXPECT_TRUE(renderer.load(alone, effects, "cpu").ok());
    return renderer.draw(camera, 64, 64, 1).value().picture;
  };
  const image::Image one = drawn(effects_of(alone)), other = drawn(both);
  float largest = 0, apart = 0;
  for (std::size_t i = 0; i < one.data.size(); ++i) {
    largest = std::max(largest, one.data[i]);
    apart = std::max(apart, std::abs(one.data[i] - other.data[i]));
  }
  EXPECT_GT(largest, 0.05F);
  EXPECT_LE(apart, 16 * 6e-8F * std::max(1.0F, largest));
}

TEST_F(EffectUnion, TakesTheLobesOfAnEnvironmentAsTheBasisHasThem) {
  envmap::PrefilteredEnvironment env;
  for (const double exponent : {1.3F, 12.5F, 900.0F}) env.lobes.emplace_back().exponent = exponent;
  const Effects all = with_all_lobes(effects_of(scene(paint_of({1.3, 40}, false))), env);
  std::vector<double> exponents;
  for (const Effects::LobeUse& use : all.lobes) exponents.push_back(use.exponent);
  EXPECT_EQ(exponents, (std::vector<double>{1.3, 12.5, 40, 900}));
}

}  // namespace
}  // namespace goniochrome::render::effect_union_test
