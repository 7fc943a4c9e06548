// Lamps that stand at a place: the engines of prefiltered maps against each other, against the reference, and against
// the law of inverse squares.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "render/exact.h"
#include "render/internal/placed_lamps.h"
#include "render/internal/seen.h"
#include "render/picture_error.h"
#include "render/renderer.h"
#include "render/scene_effects.h"
#include "render/scenes_for_test.h"
#include "render/surface_layer.h"

namespace goniochrome::render::placed_lamps_test {
namespace {

// Two columns of a turned brush, of two lobes.
brdf::SbrdfTexture map_of_two_lobes() {
  return {2, 1, 2, {0.02F, 0.03F, 0.05F, 1,    0,    0.4F,  0.3F,  0.1F, -1, -0.4F,
                    1,     12,    2,     1.8F, 1.4F, -1,    -0.9F, 1,    80,  //
                    0.05F, 0.02F, 0.01F, 0.6F, 0.8F, 0.3F,  0.3F,  0.3F, -1, -1,
                    1,     20,    0.5F,  0.6F, 0.9F, -0.8F, -0.9F, 1,    40}};
}

class PlacedLamps : public testing::Test {
 protected:
  PlacedLamps() {
    scene.mesh = &mesh;
    paint.diffuse = {0.1, 0.05, 0.02};
    paint.lobes = {{4, {0.1, 0.1, 0.15}, {}}, {64, {}, {0.6, 0.6, 0.6}}};
    paint.coat_index = 1.5;
    scene.paints = {paint};
    look();
  }
  void look() { view = {Camera::orbit(mesh, 30, 20, 1, 30, 1), 96, 96, 1, true}; }
  // A lamp so far from the middle of the mesh, which it lights as `white` there.
  Light placed(const Vec3& position, const color::Rgb& white, double radius_rad = 0) const {
    const Vec3 toward = position - origin_of(mesh);
    Light light{normalized(toward), white, radius_rad};
    light.place = Light::Place{position, length(toward)};
    return light;
  }
  void lay(const PartSurface& surface) {
    layer = std::make_unique<SurfaceLayer>(scene, std::vector<PartSurface>{surface}, brdf::CriticalAngle::kSlide);
    scene.layer = layer.get();
  }
  Frame drawn(const char* engine) const {
    auto renderer = Renderer::create();
    EXPECT_TRUE(renderer.ok());
    const auto loaded = renderer->load(scene, engine);
    EXPECT_TRUE(loaded.ok()) << loaded.error().message;
    Frame frame;
    EXPECT_TRUE(renderer->draw(view, frame).ok());
    return frame;
  }
  std::string refused(const char* engine) const {
    auto renderer = Renderer::create();
    const auto loaded = renderer->load(scene, engine);
    return loaded.ok() ? "" : loaded.error().message;
  }
  static double worst(const Frame& a, const Frame& b) {
    double most = 0;
    for (std::size_t i = 0; i < a.picture.data.size(); i += 4) {
      const float *p = &a.picture.data[i], *q = &b.picture.data[i];
      EXPECT_TRUE(std::isfinite(p[0] + p[1] + p[2] + q[0] + q[1] + q[2])) << i;
      most = std::max(most, seen_difference({p[0], p[1], p[2]}, {q[0], q[1], q[2]}, 1));
    }
    return most;
  }
  // Lamps at a place that is far away are lamps without one; that their place matters where they stand is the control.
  void expect_place(const char* what) {
    constexpr double kFar = 1e4;
    for (const int samples : {1, 4}) {
      view.samples = samples;
      const Frame near = drawn("cpu");
      const std::vector<Light> lights = scene.lights;
      for (Light& light : scene.lights)
        if (light.place) light.place = Light::Place{origin_of(mesh) + kFar * light.direction, kFar};
      const Frame far = drawn("cpu");
      for (Light& light : scene.lights) light.place.reset();
      const Frame without = drawn("cpu");
      EXPECT_LT(worst(far, without), 0.05) << what << samples;
      EXPECT_GT(worst(near, without), 5) << what << samples;
      scene.lights = lights;
    }
    view.samples = 1;
  }

  mesh::Mesh mesh = sphere_mesh(64);
  envmap::PrefilteredEnvironment env = uneven_env({4, 16, 64, 256}, {8, 16, 32, 32});
  brdf::SbrdfTexture map = map_of_two_lobes();
  paint::LobeFit paint;
  Scene scene;
  View view;
  std::unique_ptr<SurfaceLayer> layer;
};

// A matt square that faces a point lamp: the radiance is albedo W cos/(distance/reach)^2 at every pixel.
TEST_F(PlacedLamps, LightFallsWithTheSquareOfTheDistance) {
  mesh = panels_mesh(4);
  scene.paints.assign(4, matt({0.5, 0.4, 0.3}));
  view.camera = {{0, 0, 6}, {0, 0, 0}, {0, 1, 0}, 40};
  scene.lights = {placed({0.7, 0.2, 0.8}, {1, 0.9, 0.8})};
  const double reach2 = 0.7 * 0.7 + 0.2 * 0.2 + 0.8 * 0.8;
  const Frame frame = drawn("cpu");
  double least = 1e9, most = 0;
  for (int y = 0; y < frame.picture.height; ++y) {
    for (int x = 0; x < frame.picture.width; ++x) {
      if (frame.gbuffer->part(x, y) < 0) continue;
      const Vec3 to = Vec3{0.7, 0.2, 0.8} - mesh_point(mesh, *frame.gbuffer, x, y).position;
      const double wanted = 0.5 * (0.8 / length(to)) * reach2 / dot(to, to);
      EXPECT_NEAR(frame.picture.pixel(x, y)[0], wanted, 1e-5 * wanted) << x << y;
      least = std::min(least, wanted), most = std::max(most, wanted);
    }
  }
  EXPECT_GT(most / least, 10);
}

// In the certificate each point has its own lamps as well.
TEST_F(PlacedLamps, PaintIsThatOfTheReference) {
  scene.lights = {placed({1.4, 0.9, 0.8}, {1, 0.8, 0.6}), {normalized({-1, 0.2, 0.3}), {0.1, 0.2, 0.4}}};
  expect_place("paint");
  const Frame frame = drawn("cpu");
  EXPECT_LT(picture_error(frame, scene, nullptr, 1, 500, 5).de00_max, 0.02);
  scene.env = &env;
  expect_place("paint in an environment");
  scene.reflection = color::iso_rgb_operator();
  scene.anisotropy = {{0.1, 0.4}};
  expect_place("brushed paint in colored light");
}

// A far lamp with an extent beside it: what stands at a place goes through the tables of discs.
TEST_F(PlacedLamps, StandBesideDiscs) {
  scene.lights = {placed({1.4, 0.9, 0.8}, {1, 0.8, 0.6}), {normalized({-1, 0.2, 0.3}), {0.1, 0.2, 0.4}, 0.1}};
  ASSERT_TRUE(effects_of(scene).extent);
  expect_place("discs");
  EXPECT_LT(picture_error(drawn("cpu"), scene, nullptr, 1, 500, 5).de00_p95, 0.05);
}

// Maps take a sphere by the variance of its disc, which is another at each point.
TEST_F(PlacedLamps, MapsAreLitByPointsAndSpheres) {
  scene.paints = {{}};
  for (const double radius : {0.0, 0.12}) {
    scene.env = nullptr;
    scene.lights = {placed({1.3, 0.7, 1.0}, {1, 0.8, 0.6}, radius), {normalized({-1, 0.2, 0.3}), {0.1, 0.2, 0.4}}};
    lay({{{&map, 3}}});
    ASSERT_EQ(effects_of(scene).extent, radius > 0);
    expect_place("map");
    // The reference has the integral of a sphere, from which a Gaussian differs the more the wider the sphere is seen.
    if (radius == 0) {
      EXPECT_LT(picture_error(drawn("cpu"), scene, nullptr, 1, 500, 5).de00_p95, 0.05);
    }
    scene.env = &env;
    lay({{{&map, 3}}});
    expect_place("map in an environment");
  }
}

TEST_F(PlacedLamps, MeshesFarFromTheirOriginAreAsSharp) {
  scene.lights = {placed({1.4, 0.9, 0.8}, {1, 0.8, 0.6})};
  const Frame near = drawn("cpu");
  const Vec3 away{4e4, -2e4, 1e4};
  for (Vec3& position : mesh.positions) position += away;
  view.camera.eye += away, view.camera.target += away;
  scene.lights = {placed(Vec3{1.4, 0.9, 0.8} + away, {1, 0.8, 0.6})};
  const Frame far = drawn("cpu");
  std::vector<double> de00;
  for (std::size_t i = 0; i < far.picture.data.size(); i += 4) {
    const float *p = &far.picture.data[i], *q = &near.picture.data[i];
    if (p[3] > 0 && q[3] > 0) de00.push_back(seen_difference({p[0], p[1], p[2]}, {q[0], q[1], q[2]}, 1));
  }
  EXPECT_LT(percentile_95(de00), 0.5);  // OpenGL finds what is visible in single precision
}

TEST_F(PlacedLamps, WhatCannotBeDrawnIsRefused) {
  scene.lights = {placed({1.4, 0.9, 0.8}, {1, 0.8, 0.6}, 0.05)};
  EXPECT_THAT(refused("cpu"), testing::HasSubstr("draws a lamp at a place that shines on paint as a point"));
  const envmap::Environment white = *envmap::Environment::from_lat_long(
      {8, 4, 3, std::vector<float>(96, 1.0F), {}}, envmap::Environment::BadPixels::kError, "white");
  const envmap::BlockTree blocks(white);
  scene.texels = &blocks;
  for (const char* engine : {"gl", "integral"})
    EXPECT_THAT(refused(engine), testing::HasSubstr("no lamps at a place: take cpu or path"));
  scene.lights = {placed({1.4, 0.9, 0.8}, {1, 0.8, 0.6})};
  EXPECT_EQ(refused("cpu"), "");
  auto seen = std::make_shared<Gbuffer>(seen_by_rays(sphere_mesh(4), view.camera, 8, 8));
  seen->triangles.clear();
  const auto given = Renderer::shading(seen).load(scene, "cpu");
  ASSERT_FALSE(given.ok());
  EXPECT_THAT(given.error().message, testing::HasSubstr("needs positions"));
}

}  // namespace
}  // namespace goniochrome::render::placed_lamps_test
