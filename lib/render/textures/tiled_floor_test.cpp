// A floor of many repetitions of a texture: footprints of pixels, and what the filter is worth.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/angles.h"
#include "base/parallel.h"
#include "base/random_for_test.h"
#include "base/text.h"
#include "render/scene_effects.h"
#include "render/textures/textured_scene_for_test.h"

namespace goniochrome::render::tiled_floor_test {
namespace {

// Each texel has a direction, strengths, colors and exponents of its own.
brdf::SbrdfTexture random_metal(int width, int height) {
  TestNumbers random(7);
  const brdf::SbrdfTexture like = brushed_texture();
  brdf::SbrdfTexture texture{width, height, like.lobes, {}};
  for (int i = 0; i < width * height; ++i) {
    std::vector<float> texel(like.values.begin(), like.values.begin() + like.stride());
    const double angle = 2 * kPi * random();
    texel[3] = static_cast<float>(std::cos(angle)), texel[4] = static_cast<float>(std::sin(angle));
    for (std::size_t c = 0; c < 3; ++c) texel[c] = static_cast<float>(0.1 * random());
    for (const std::size_t lobe : {std::size_t{5}, std::size_t{12}}) {
      const double share = random();
      for (std::size_t c = 0; c < 3; ++c) texel[lobe + c] *= static_cast<float>(share * (0.7 + 0.3 * random()));
      texel[lobe + 6] *= static_cast<float>(0.5 + 1.5 * random());
    }
    texture.values.insert(texture.values.end(), texel.begin(), texel.end());
  }
  return texture;
}

// A floor on which a texture is laid 40 times, toward the horizon.
class TiledFloor : public TexturedScene {
 protected:
  TiledFloor() {
    mesh = {};
    mesh.positions = {{-10, 0, 10}, {10, 0, 10}, {10, 0, -10}, {-10, 0, -10}};
    mesh.normals.assign(4, {0, 1, 0});
    mesh.texture = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    mesh.parts = {{"floor", "", 0, 2}};
    view.camera = {{1, 1.5, 11}, {0, 0, 0}, {0, 1, 0}, 40};
    view.width = 96, view.height = 54;
    scene.lights = {{normalized({0.2, 0.5, -1}), {1, 0.8, 0.6}}};
  }
  void lay(double times) {
    layer = std::make_unique<SurfaceLayer>(scene, std::vector<PartSurface>{{{{&texture, times}}}},
                                           brdf::CriticalAngle::kSlide);
    scene.layer = layer.get();
  }
  Frame with_filter(bool filter, int samples) {
    Effects effects = effects_of(scene);
    effects.texture_filter = filter;
    view.samples = samples;
    return drawn("cpu", effects);
  }
};

// A picture with 256 samples a pixel is the truth, whose own noise is .1 to .3; one sample without the filter is the
// control (2.6 to 30). Metal that is brushed in all directions within a few texels is the hardest surface that there is
// for a level, under a lamp moreover. With one probe a texel, 1.4 were left of 8 x 4 texels that are about as large as
// pixels, 4.3 of 5 x 3 and 3.8 of 16 x 16 whose directions and lobes are random; of the last, 1.3 are left.
TEST_F(TiledFloor, OneFilteredSampleIsNearerToManyWithout) {
  struct Floor {
    int width, height, size;  // each texel becomes `size` along each side
    double times, aliased, left;
  };
  const brdf::SbrdfTexture brushed = brushed_texture();
  for (const Floor& floor : {Floor{8, 4, 1, 40, 5, 0.5}, Floor{8, 4, 8, 40, 5, 1}, Floor{8, 4, 1, 10, 2, 0.5},
                             Floor{5, 3, 1, 40, 20, 1}, Floor{16, 16, 1, 10, 20, 1.5}}) {
    const brdf::SbrdfTexture small = floor.width == 8 ? brushed : random_metal(floor.width, floor.height);
    texture = {small.width * floor.size, small.height * floor.size, small.lobes, {}};
    for (int row = 0; row < texture.height; ++row) {
      for (int column = 0; column < texture.width; ++column) {
        const float* from = small.texel(column / floor.size, row / floor.size);
        texture.values.insert(texture.values.end(), from, from + texture.stride());
      }
    }
    lay(floor.times);
    const std::string name = fmt::format("{} x {}, {} times", texture.width, texture.height, floor.times);
    const Frame truth = with_filter(false, 256), filtered = with_filter(true, 1), bare = with_filter(false, 1);
    const double aliased = difference(truth, bare), left = difference(truth, filtered);
    EXPECT_GT(aliased, floor.aliased) << name;
    EXPECT_LT(left, floor.left) << name;
    EXPECT_LT(difference(truth, with_filter(true, 4)), left) << name;
    view.samples = 1;
    EXPECT_LT(difference(filtered, drawn("gl", effects_of(scene))), 0.05) << name;
  }
}

// Without a plan the levels are made by the first row of a picture that needs them, while other rows wait: of a texture
// large enough, on several threads each.
TEST_F(TiledFloor, RowsThatNeedLevelsAtOnceAreDrawn) {
  const brdf::SbrdfTexture small = brushed_texture();
  texture = {64, 64, small.lobes, {}};
  for (int i = 0; i < 64 * 64; ++i) {
    const float* from = small.texel(i % small.width, i / 64 % small.height);
    texture.values.insert(texture.values.end(), from, from + texture.stride());
  }
  const auto drawn_by = [&](int threads) {
    set_threads(threads);
    lay(40);
    return with_filter(true, 1);
  };
  const Frame one = drawn_by(1);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(drawn_by(8).picture.data, one.picture.data);
  set_threads(0);
}

// A file may state texture coordinates, and a user a number of repetitions, that no float can hold.
TEST_F(TiledFloor, PlacesBeyondAllNumbersAreDrawn) {
  for (const float far : {3e38F, std::numeric_limits<float>::infinity()}) {
    mesh.texture[2] = {far, far};
    for (const double times : {1.0, 1e300}) {
      lay(times);
      for (const bool filter : {false, true}) {
        for (const char* engine : {"cpu", "gl"}) {
          Effects effects = effects_of(scene);
          effects.texture_filter = filter;
          view.samples = 1;
          const Frame frame = drawn(engine, effects);
          const auto is_bad = [](float value) { return !std::isfinite(value); };
          EXPECT_TRUE(std::ranges::none_of(frame.picture.data, is_bad)) << far << ' ' << times << ' ' << engine;
        }
      }
    }
  }
}

TEST_F(TiledFloor, ThePlanKnowsWhatTheFilterIsWorth) {
  lay(40);
  Frame with, without;
  view.samples = 1;
  PlanRequest request;
  request.effects = {Start::kAll};
  const Plan plan = planned(request, with);
  request.effects = {Start::kAll, {{"texture-filter", false}}};
  const Plan bare = planned(request, without);
  EXPECT_TRUE(item(plan, "texture-filter").needed);
  EXPECT_EQ(item(bare, "texture-filter").decision, Decision::kForcedOff);
  const double real = difference(with, without), estimate = item(plan, "texture-filter").de00_p95;
  EXPECT_NEAR(std::log2(estimate / real), 0, 0.5) << estimate << " for " << real;
  request.effects = {};
  EXPECT_EQ(item(planned(request, with), "texture-filter").decision, Decision::kDrawn);
  lay(0.2);
  EXPECT_FALSE(item(planned(request, with), "texture-filter").needed) << "texels are larger than pixels";
}

}  // namespace
}  // namespace goniochrome::render::tiled_floor_test
