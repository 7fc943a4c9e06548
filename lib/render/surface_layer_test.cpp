#include "render/surface_layer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/parallel.h"
#include "brdf/lobe_model.h"
#include "render/scenes_for_test.h"

namespace goniochrome::render::surface_layer_test {
namespace {

// A G-buffer of one row: the points of a sphere from the middle to the right, seen from +Z.
Gbuffer sphere_row(int n) {
  Gbuffer g;
  g.width = n, g.height = 1;
  for (int x = 0; x < n; ++x) {
    const double s = (x + 0.5) / n * 0.95;
    for (const double value : {s, 0.0, std::sqrt(1 - s * s), 1.0}) g.data.push_back(static_cast<float>(value));
  }
  g.rays = {{-1e-9, 0, -1}, {1e-12, 0, 0}, {0, -1e-12, 0}};
  return g;
}

Effects effects_of_maps() {
  Effects effects;
  effects.maps = true, effects.lights = 1;
  return effects;
}

brdf::ColorMap even_map(float value) {
  brdf::ColorMap map = brdf::color_map_of_size(8, 1.5);
  for (float& factor : map.factors) factor = value;
  return map;
}

struct Stage {
  mesh::Mesh mesh = sphere_mesh(8);
  Scene scene;
  Stage() {
    scene.mesh = &mesh;
    paint::LobeFit paint;
    paint.diffuse = {0.05, 0.05, 0.05};
    paint.lobes = {{20, {0.2, 0.1, 0.1}, {3, 3, 3}}};
    scene.paints = {paint};
    scene.lights = {{normalized({0.4, 0.3, 1}), {2, 2, 1}}};
  }
};

TEST(SurfaceLayer, AColorMapTakesTheFlakesPlaceAndLeavesTheGloss) {
  const Stage stage;
  const brdf::ColorMap map = even_map(0.4F);
  const SurfaceLayer layer(stage.scene, {{{}, &map}}, brdf::CriticalAngle::kSlide);
  ASSERT_FALSE(layer.empty());
  const Gbuffer g = sphere_row(40);
  for (int x = 0; x < g.width; x += 3) {
    const Vec3 n = g.normal(x, 0), v = g.to_viewer(x, 0);
    const Light& light = stage.scene.lights[0];
    const double cos_i = dot(n, light.direction);
    const color::Rgb lobes = (M_PI * cos_i) * (light.white * brdf::brdf(stage.scene.paints[0], light.direction, v, n));
    const color::Rgb sum = lobes + layer.mapped_difference(0, n, v);
    // White of the map, and the gloss lobe alone.
    paint::LobeFit gloss_alone;
    gloss_alone.lobes = {{20, {}, {3, 3, 3}}};
    const color::Rgb gloss = (M_PI * cos_i) * (light.white * brdf::brdf(gloss_alone, light.direction, v, n));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], cos_i * light.white[c] * 0.4F + gloss[c], 1e-12) << x;
  }
}

TEST(SurfaceLayer, AddsItsWeightAndNothingElsewhere) {
  const Stage stage;
  const brdf::ColorMap map = even_map(1);
  const SurfaceLayer layer(stage.scene, {{{}, &map}}, brdf::CriticalAngle::kClip);
  Gbuffer g = sphere_row(8);
  g.data[3] = 0;  // the first pixel misses the mesh
  image::Image picture{8, 1, 4, std::vector<float>(32, 1), {}};
  layer.add(g, {}, effects_of_maps(), 0.25F, picture);
  EXPECT_EQ(picture.data[0], 1);
  EXPECT_EQ(picture.data[7], 1);  // coverage
  const color::Rgb whole = layer.mapped_difference(0, g.normal(3, 0), g.to_viewer(3, 0));
  EXPECT_NEAR(picture.data[12], 1 + 0.25 * whole.x, 1e-6);
  const SurfaceLayer none(stage.scene, {}, brdf::CriticalAngle::kClip);
  EXPECT_TRUE(none.empty());
  // Without lights a color map adds nothing: an environment is lit by the paint's lobes.
  Stage dark;
  dark.scene.lights.clear();
  const SurfaceLayer unlit(dark.scene, {{{}, &map}}, brdf::CriticalAngle::kClip);
  EXPECT_FALSE(unlit.mapped());
  EXPECT_FALSE(unlit.empty());  // paths evaluate it under every light
}

TEST(SurfaceLayer, BitsDoNotDependOnTheThreads) {
  const Stage stage;
  brdf::SbrdfTexture texture = {1, 1, 1, {0.1F, 0.1F, 0.1F, 1, 0, 1, 1, 1, -1, -1, 1, 30}};
  Effects effects;
  effects.texture = true, effects.lights = 1;
  const SurfaceLayer layer(stage.scene, {{{{&texture, 2}}}}, brdf::CriticalAngle::kClip);
  Camera camera;
  camera.eye = {0, 0, 5};
  const Gbuffer g = seen_by_rays(stage.mesh, camera, 16, 16);
  std::vector<std::vector<float>> pictures;
  for (const int n : {1, 2, 7}) {
    set_threads(n);
    image::Image picture{16, 16, 4, std::vector<float>(1024, 0), {}};
    layer.add(g, layer.places(g), effects, 1, picture);
    pictures.push_back(picture.data);
  }
  set_threads(0);
  EXPECT_EQ(pictures[0], pictures[1]);
  EXPECT_EQ(pictures[0], pictures[2]);
  EXPECT_GT(pictures[0][4 * 136], 0);
}

}  // namespace
}  // namespace goniochrome::render::surface_layer_test
