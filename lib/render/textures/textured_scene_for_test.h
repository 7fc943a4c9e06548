// A textured sphere under a light whose integrals are known, for the tests of textures.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/angles.h"
#include "render/internal/seen.h"
#include "render/renderer.h"
#include "render/scenes_for_test.h"
#include "render/surface_layer.h"

namespace goniochrome::render {

// 1 + k d in every channel, each along an axis of its own: P_n of it is known.
inline Vec3 sloping(const Vec3& d, double k) {
  return {1 + 0.6 * k * d.x, 1 + 0.6 * k * d.y, 1 - 0.6 * k * d.z};
}

inline envmap::PrefilteredEnvironment sloping_env() {
  envmap::PrefilteredEnvironment env;
  const auto filtered = [](double n) {
    return cube_of(32, [n](const Vec3& d) { return sloping(d, (n + 1) / (n + 2)); });
  };
  env.diffuse.map = filtered(1);
  for (const double n : {4.0, 16.0, 64.0, 256.0}) {
    env.lobes.emplace_back();
    env.lobes.back().exponent = n;
    env.lobes.back().map = filtered(n);
  }
  env.source = "sloping.exr";
  return env;
}

inline envmap::Environment sloping_source() {
  image::Image image{256, 128, 3, std::vector<float>(std::size_t{256} * 128 * 3, 0.0F), {}};
  const auto plain = envmap::Environment::from_lat_long(image, envmap::Environment::BadPixels::kError, "plain");
  for (int row = 0; row < 128; ++row) {
    for (int column = 0; column < 256; ++column) {
      const Vec3 value = sloping(plain->direction(column, row), 1);
      for (int c = 0; c < 3; ++c) image.pixel(column, row)[c] = static_cast<float>(value[c]);
    }
  }
  return *envmap::Environment::from_lat_long(std::move(image), envmap::Environment::BadPixels::kError, "sloping");
}

// Metal brushed in a direction that turns across, darker in every other row; its last lobe is next to nothing.
inline brdf::SbrdfTexture brushed_texture() {
  brdf::SbrdfTexture texture{8, 4, 3, {}};
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 8; ++column) {
      const double angle = 2 * kPi * column / 8;
      const float share = row % 2 == 0 ? 1.0F : 0.5F;
      for (const float value : {0.02F,
                                0.02F,
                                0.02F,
                                static_cast<float>(std::cos(angle)),
                                static_cast<float>(std::sin(angle)),
                                0.8F * share,
                                0.7F * share,
                                0.5F * share,
                                -1.0F,
                                -0.3F,
                                1.0F,
                                12.0F,  //
                                2.0F * share,
                                1.8F * share,
                                1.4F * share,
                                -1.0F,
                                -0.9F,
                                1.0F,
                                80.0F,  //
                                1e-5F,
                                1e-5F,
                                1e-5F,
                                -1.0F,
                                -1.0F,
                                1.0F,
                                30.0F})
        texture.values.push_back(value);
    }
  }
  return texture;
}

class TexturedScene : public testing::Test {
 protected:
  TexturedScene() {
    scene.mesh = &mesh;
    scene.paints = {{}};
    scene.env = &env;
    view = {Camera::orbit(mesh, 30, 20, 1, 30, 1), 96, 96, 1, true};
  }
  void dress() {
    layer =
        std::make_unique<SurfaceLayer>(scene, std::vector<PartSurface>{{{{&texture, 6}}}}, brdf::CriticalAngle::kSlide);
    scene.layer = layer.get();
  }
  Frame drawn(const char* engine, const Effects& effects, int bounces = Effort::kUsualBounces) const {
    auto renderer = Renderer::create();
    EXPECT_TRUE(renderer.ok());
    renderer->set_effort({bounces});
    const auto loaded = renderer->load(scene, effects, engine);
    EXPECT_TRUE(loaded.ok()) << loaded.error().message;
    Frame frame;
    EXPECT_TRUE(renderer->draw(view, frame).ok());
    return frame;
  }
  Plan planned(PlanRequest request, Frame& frame) const {
    auto renderer = Renderer::create();
    EXPECT_TRUE(renderer.ok());
    const auto seen = renderer->look(mesh, view);
    EXPECT_TRUE(seen.ok());
    auto plan = renderer->load(scene, {*seen}, request);
    EXPECT_TRUE(plan.ok()) << plan.error().message;
    EXPECT_TRUE(renderer->draw(view, frame).ok());
    return *std::move(plan);
  }
  static double difference(const Frame& a, const Frame& b) {
    std::vector<double> de00;
    for (int y = 0; y < a.picture.height; ++y) {
      for (int x = 0; x < a.picture.width; ++x) {
        if (a.gbuffer->part(x, y) < 0) continue;
        const float *p = a.picture.pixel(x, y), *q = b.picture.pixel(x, y);
        if (p[3] < 0.999F || q[3] < 0.999F) continue;  // an edge, of which samples see another part
        de00.push_back(seen_difference({p[0], p[1], p[2]}, {q[0], q[1], q[2]}, 1));
      }
    }
    return percentile_95(std::move(de00));
  }
  static const PlanItem& item(const Plan& plan, const std::string& name) {
    for (const PlanItem& item : plan.items)
      if (item.effect == name) return item;
    ADD_FAILURE() << name << " is not in the plan";
    return plan.items.front();
  }

  mesh::Mesh mesh = sphere_mesh(64);
  envmap::PrefilteredEnvironment env = sloping_env();
  brdf::SbrdfTexture texture = brushed_texture();
  Scene scene;
  View view;
  std::unique_ptr<SurfaceLayer> layer;
};

}  // namespace goniochrome::render
