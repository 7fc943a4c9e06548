// The light that the search of a picture's paint sees, against what the renderer draws.
#include "sketch/sketch_light.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/angles.h"
#include "envmap/open_maps.h"
#include "render/aov.h"
#include "render/effects.h"
#include "render/renderer.h"
#include "render/scene_effects.h"
#include "render/scenes_for_test.h"

namespace goniochrome::sketch::sketch_light_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::vector<double> kExponents = {2, 20, 300};

envmap::PrefilteredEnvironment uneven_env() {
  envmap::PrefilteredEnvironment env = render::constant_env({1, 1, 1}, kExponents);
  // A lobe of exponent E keeps (E+1)/(E+2) of what changes with the direction to first order.
  const auto filtered = [](double kept) {
    return render::cube_of(16, [kept](const Vec3& d) {
      return Vec3{1 + 0.4 * kept * d.y, 0.8 + 0.2 * kept * d.x, 0.7 + 0.3 * kept * d.z};
    });
  };
  env.mirror.map = filtered(1), env.diffuse.map = filtered(2.0 / 3);
  for (envmap::PrefilteredLobe& lobe : env.lobes) lobe.map = filtered((lobe.exponent + 1) / (lobe.exponent + 2));
  return env;
}

paint::LobeFit paint(bool mirror = true) {
  paint::LobeFit fit = render::matt({0.1, 0.2, 0.3});
  fit.lobes = {{2, {0.04, 0.02, 0.03}, {}},
               {20, {}, {0.2, 0.2, 0.2}},
               {300, {0.4, 0.3, 0.2}, {}},
               {paint::kMirrorExponent, {}, mirror ? color::Rgb{1, 1, 1} : color::Rgb{}}};
  return fit;
}

struct Drawing {
  image::AovFile buffers;
  image::Image picture;
};

// A sphere of that paint with these effects alone, and its buffers.
Drawing draw(const envmap::PrefilteredEnvironment& env, const std::vector<std::string>& drawn, int samples = 1,
             double extent_deg = 0) {
  const auto has = [&](const char* name) { return std::ranges::find(drawn, name) != drawn.end(); };
  const mesh::Mesh mesh = render::sphere_mesh(64);
  render::Scene scene;
  scene.mesh = &mesh, scene.paints = {paint(extent_deg == 0)}, scene.env = &env;
  if (has("coat")) scene.paints.front().coat_index = 1.5;
  scene.lights = {{normalized(Vec3{1, 1, 2}), {0.5, 0.6, 0.7}, 0.5 * extent_deg * kDegree}};
  scene.gloss_deg = {60}, scene.reflection = color::iso_rgb_operator();
  render::Effects effects = render::effects_of(scene);
  if (!has("spots")) effects.spots = 0;
  effects.fresnel = has("fresnel"), effects.horizon = has("horizon"), effects.reflection = has("operator");
  auto renderer = render::Renderer::create();
  EXPECT_TRUE(renderer.ok());
  EXPECT_TRUE(renderer->load(scene, effects, "cpu").ok());
  render::Camera camera;
  camera.eye = {0, 0, 5};
  const render::Frame frame = *renderer->draw(camera, 40, 40, samples, true);
  Drawing result{{}, frame.picture};
  image::AovFile& buffers = result.buffers;
  buffers.path = "scene.exr", buffers.image = frame.picture, buffers.drawn = drawn, buffers.has_rays = true;
  buffers.samples = samples;
  buffers.image.channel_names = {"R", "G", "B", "A"};
  for (const char* aov : {"normal", "part"})
    EXPECT_TRUE(render::add_aov(buffers.image, *frame.gbuffer, aov, scene.lights.front().direction).ok());
  buffers.lights = {{scene.lights.front().direction, scene.lights.front().white, extent_deg}};
  const render::Rays& rays = frame.gbuffer->rays;
  buffers.corner = rays.corner, buffers.right = rays.right, buffers.down = rays.down;
  return result;
}

// The largest difference of a channel, relative to the brightest, where the sphere is seen within that angle from its
// normal.
double difference(const Drawing& drawing, const SketchLight& light, double steepest_deg = 80, bool mirror = true) {
  const paint::LobeFit fit = paint(mirror);
  std::vector<color::Rgb> weights(search_columns(light.basis));
  weights.front() = fit.diffuse, weights.back() = fit.lobes.back().gloss;
  for (std::size_t j = 0; j < 3; ++j)
    weights[1 + 2 * j] = fit.lobes[j].directional_diffuse, weights[2 + 2 * j] = fit.lobes[j].gloss;
  std::vector<Vec3> columns(weights.size());
  double apart = 0, brightest = 0;
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x) {
      const float* pixel = drawing.buffers.image.pixel(x, y);
      const Vec3 normal{pixel[4], pixel[5], pixel[6]};
      if (dot(normal, drawing.buffers.to_viewer(x, y)) < std::cos(steepest_deg * kDegree)) continue;
      light.shade(static_cast<std::uint32_t>(40 * y + x), columns.data());
      color::Rgb sum;
      const color::ReflectionOperator op = light.reflection.value_or(color::component_wise());
      for (std::size_t k = 0; k < columns.size(); ++k) sum += color::reflected(op, columns[k], weights[k]);
      for (int c = 0; c < 3; ++c)
        apart = std::max(apart, std::abs(sum[c] - pixel[c])), brightest = std::max<double>(brightest, pixel[c]);
    }
  return apart / brightest;
}

// Adds to the maps what these spots give to them.
void light_up(envmap::PrefilteredEnvironment& env, const std::vector<envmap::Spot>& spots) {
  std::vector<envmap::Spot> dark = spots;
  for (envmap::Spot& spot : dark) spot.white = -1.0 * spot.white;
  env.coat_diffuse = std::make_shared<const envmap::CubeMap>(
      envmap::diffuse_without_spots(*envmap::coat_diffuse_map(env), true, dark));
  env.diffuse.map = envmap::diffuse_without_spots(env.diffuse.map, false, dark);
  for (envmap::PrefilteredLobe& lobe : env.lobes) lobe.map = envmap::without_spots(lobe.map, lobe.exponent, dark);
  env.spots = spots;
}

// The engine's arithmetic is single precision, its cosine powers good to 1e-3 of a lobe's peak. The control: light that
// does not know what was drawn.
TEST(SketchLight, IsWhatTheRendererDrawsWithTheSameEffects) {
  const envmap::PrefilteredEnvironment smooth = uneven_env();
  envmap::PrefilteredEnvironment spotted = smooth;
  light_up(spotted, {{normalized(Vec3{1, 0.2, 0.1}), {0.3, 0.2, 0.2}, 0.05},
                     {normalized(Vec3{-1, 1, 1}), {0.1, 0.1, 0.2}, 0.3}});
  const std::vector<std::vector<std::string>> all = {{},
                                                     {"fresnel"},
                                                     {"horizon"},
                                                     {"operator"},
                                                     {"coat"},
                                                     {"horizon", "spots"},
                                                     {"fresnel", "coat", "horizon", "spots", "operator"}};
  for (const auto& drawn : all) {
    const envmap::PrefilteredEnvironment& env = std::ranges::count(drawn, "spots") > 0 ? spotted : smooth;
    Drawing drawing = draw(env, drawn);
    const auto light = sketch_light(drawing.buffers, env);
    ASSERT_TRUE(light.ok());
    EXPECT_EQ(light->reflection.has_value(), std::ranges::find(drawn, "operator") != drawn.end());
    EXPECT_LT(difference(drawing, *light), 2e-3) << testing::PrintToString(drawn);
    if (drawn.empty()) continue;
    drawing.buffers.drawn.clear();
    EXPECT_GT(difference(drawing, *sketch_light(drawing.buffers, env)), 5e-3) << testing::PrintToString(drawn);
  }
}

// Lamps that are discs, without their mirror images, whose edges lie within pixels. The control: lamps as points.
TEST(SketchLight, KnowsTheExtentOfLamps) {
  const envmap::PrefilteredEnvironment env = uneven_env();
  for (const double extent_deg : {8.0, 40.0}) {
    Drawing drawing = draw(env, {"fresnel", "horizon", "extent"}, 1, extent_deg);
    EXPECT_LT(difference(drawing, *sketch_light(drawing.buffers, env), 80, false), 2e-3) << extent_deg;
    drawing.buffers.drawn.pop_back();
    EXPECT_TRUE(lamps_are_discs(drawing.buffers));  // the paint that was drawn does not show it, others may
    drawing.buffers.left_out = {"extent"};
    EXPECT_FALSE(lamps_are_discs(drawing.buffers));
    EXPECT_GT(difference(drawing, *sketch_light(drawing.buffers, env), 80, false), 0.02) << extent_deg;
  }
}

TEST(SketchLight, WantsLampsFarAway) {
  const envmap::PrefilteredEnvironment env = uneven_env();
  Drawing drawing = draw(env, {"extent"}, 1, 8);
  drawing.buffers.lights.front().is_placed = true;
  const auto light = sketch_light(drawing.buffers, env);
  ASSERT_FALSE(light.ok());
  EXPECT_THAT(light.error().message, HasSubstr("lamp at a place"));
}

// Light that changes within a pixel. The control: light of the centers of the pixels alone.
TEST(SketchLight, IsTheMeanOverTheSamplesOfAPixel) {
  envmap::PrefilteredEnvironment env = render::constant_env({1, 1, 1}, kExponents);
  const auto stripes = [](const Vec3& d) { return (1 + 0.9 * std::sin(4 * (d.x + d.y))) * Vec3{1, 1, 1}; };
  env.mirror.map = render::cube_of(64, stripes);
  for (envmap::PrefilteredLobe& lobe : env.lobes) lobe.map = env.mirror.map;
  Drawing drawing = draw(env, {}, 4);
  const double apart = difference(drawing, *sketch_light(drawing.buffers, env), 45);
  drawing.buffers.samples = 1;
  EXPECT_LT(apart, 0.3 * difference(drawing, *sketch_light(drawing.buffers, env), 45));
}

TEST(SketchLight, WantsNormalsAndRays) {
  const envmap::PrefilteredEnvironment env = uneven_env();
  Drawing drawing = draw(env, {});
  drawing.buffers.has_rays = false;
  auto light = sketch_light(drawing.buffers, env);
  ASSERT_FALSE(light.ok());
  EXPECT_THAT(light.error().message, HasSubstr("goniochrome:rays"));
  drawing.buffers.image.channel_names[4] = "other";
  light = sketch_light(drawing.buffers, env);
  ASSERT_FALSE(light.ok());
  EXPECT_THAT(light.error().message, HasSubstr("no channel \"normal.X\""));
  EXPECT_THAT(light.error().message, HasSubstr("--aov normal,aspecular,lambert,mask,part"));
}

TEST(SketchLight, TellsTheEffectsThatItLacks) {
  image::AovFile buffers;
  buffers.drawn = {"diffuse", "lobe-20", "fresnel", "horizon", "texture", "operator", "anisotropy"};
  EXPECT_THAT(effects_without_light(buffers), ElementsAre("anisotropy", "texture"));
}

}  // namespace
}  // namespace goniochrome::sketch::sketch_light_test
