// The predicted error of an effect, and the error by the exact integral where it is left out: each effect in a scene
// where it matters, in light that changes fast.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "envmap/environment.h"
#include "render/exact.h"
#include "render/picture_error.h"
#include "render/renderer.h"
#include "render/scene_effects.h"
#include "render/scenes_for_test.h"

namespace goniochrome::render::estimates_test {
namespace {

// A room: a bright strip in the ceiling, a blue window, a dark floor.
envmap::Environment room() {
  image::Image image{64, 32, 3, {}, {}};
  for (int row = 0; row < 32; ++row) {
    for (int column = 0; column < 64; ++column) {
      const bool strip = row >= 4 && row < 8 && column % 32 > 6, window = row >= 10 && row < 16 && column < 12;
      const Vec3 wall = row < 16 ? Vec3{0.5, 0.45, 0.4} : Vec3{0.05, 0.04, 0.04};
      const Vec3 light = strip ? Vec3{8, 7.5, 6.5} : window ? Vec3{1, 2.5, 6} : wall;
      for (int c = 0; c < 3; ++c) image.data.push_back(static_cast<float>(light[c]));
    }
  }
  return *envmap::Environment::from_lat_long(std::move(image), envmap::Environment::BadPixels::kError, "room");
}

struct Room {
  // The mean of the light, by cos^E about each direction: texels are points, no wider than a lobe.
  envmap::CubeMap filtered(double exponent, int size) const {
    struct Texel {
      Vec3 direction, light;
      double size;
    };
    std::vector<Texel> texels;
    for (int row = 0; row < source.height(); ++row)
      for (int column = 0; column < source.width(); ++column) {
        const float* rgb = source.radiance(column, row);
        texels.push_back({source.direction(column, row), {rgb[0], rgb[1], rgb[2]}, source.solid_angle(column, row)});
      }
    const double nothing = std::exp(-40 / exponent);  // the cosine below which a lobe is 4e-18 of its peak
    return cube_of(size, [&](const Vec3& d) {
      Vec3 sum;
      double whole = 0;
      for (const Texel& texel : texels) {
        const double cosine = dot(d, texel.direction);
        if (cosine <= nothing) continue;
        const double weight = texel.size * std::pow(cosine, exponent);
        sum += weight * texel.light;
        whole += weight;
      }
      return (1 / whole) * sum;
    });
  }

  envmap::Environment source = room();
  envmap::PrefilteredEnvironment env;
  mesh::Mesh mesh = sphere_mesh(64);
  View view{Camera::orbit(mesh, 30, 20, 1, 30, 1), 96, 96, 1, true};
  Room() {
    env = constant_env({0, 0, 0}, {1.3, 6, 60});
    env.diffuse.map = filtered(1, 8);
    env.lobes[0].map = filtered(1.3, 12), env.lobes[1].map = filtered(6, 24), env.lobes[2].map = filtered(60, 48);
    env.mirror.map = cube_of(96, [&](const Vec3& d) {
      const float* texel = source.lookup(d);
      return Vec3{texel[0], texel[1], texel[2]};
    });
  }
};

const Room& shared_room() {
  static const Room room;
  return room;
}

paint::LobeFit wide_flakes() {
  paint::LobeFit paint = matt({0.02, 0.02, 0.03});
  paint.lobes = {{1.3, {0.03, 0.03, 0.03}, {}}, {6, {0.12, 0.12, 0.13}, {}}, {60, {0.3, 0.3, 0.3}, {}}};
  return paint;
}

paint::LobeFit coated(const color::Rgb& color) {
  paint::LobeFit paint = matt(color);
  paint.lobes = {{60, {}, {0.5, 0.5, 0.5}}, {paint::kMirrorExponent, {}, {1, 1, 1}}};
  return paint;
}

paint::LobeFit brushed_metal() {
  paint::LobeFit paint = matt({0.02, 0.02, 0.02});
  paint.lobes = {{60, {3, 3, 3}, {}}};
  return paint;
}

// Blue seen straight on, red from the side.
paint::LobeFit traveling() {
  paint::LobeFit paint = matt({0.05, 0.05, 0.05});
  paint.lobes = {{6, {0.1, 0.1, 0.1}, {}}};
  paint.views = {{0, paint.diffuse, {{6, {0.02, 0.06, 0.2}, {}}}}, {70, paint.diffuse, {{6, {0.2, 0.05, 0.03}, {}}}}};
  return paint;
}

struct Matter {
  const char* effect;
  paint::LobeFit paint;
  paint::Anisotropy brushed = {};
  color::ReflectionOperator reflection = color::component_wise();
  friend void PrintTo(const Matter& matter, std::ostream* out) { *out << matter.effect; }
};

std::vector<Matter> where_it_matters() {
  const paint::LobeFit red = matt({0.6, 0.05, 0.03}), flakes = wide_flakes();
  return {{"diffuse", red},
          {"lobes", flakes},
          {"horizon", flakes},
          {"gloss", coated({0.05, 0.05, 0.05})},
          {"mirror", coated({0.05, 0.05, 0.05})},
          {"fresnel", coated({0.02, 0.02, 0.1})},
          {"anisotropy", brushed_metal(), {0.1, 0.3}},
          {"travel", traveling()},
          {"operator", red, {}, color::working_space_operator()}};
}

class Estimates : public testing::TestWithParam<Matter> {};

// The 95th percentile of so many random pixels lies between the 85th and the 100th of all: a good part of the factor 2.
constexpr int kChecked = 32;

TEST_P(Estimates, AreTheErrorsOfTheCheck) {
  const Matter& matter = GetParam();
  const Room& room = shared_room();
  Scene scene;
  scene.mesh = &room.mesh, scene.env = &room.env;
  scene.paints = {matter.paint};
  if (matter.brushed.alpha_x > 0) scene.anisotropy = {matter.brushed};
  scene.reflection = matter.reflection;
  const double white = diffuse_white(&room.env, {}).luminance;
  auto renderer = Renderer::create();
  ASSERT_TRUE(renderer.ok());
  const auto seen = renderer->look(room.mesh, room.view);
  PlanRequest request;
  request.effects = {Start::kAll, {{matter.effect, false}}};
  request.white_luminance = white;
  const auto plan = renderer->load(scene, {*seen}, request);
  ASSERT_TRUE(plan.ok()) << plan.error().message;
  Frame without, with;
  ASSERT_TRUE(renderer->draw(room.view, without).ok());
  ASSERT_TRUE(renderer->load(scene, "cpu").ok());
  ASSERT_TRUE(renderer->draw(room.view, with).ok());
  const double missed = picture_error(without, scene, &room.source, white, kChecked, 1).de00_p95;
  const double left = picture_error(with, scene, &room.source, white, kChecked, 1).de00_p95;
  std::printf("%-10s predicted %6.2f  checked %6.2f  with it %5.2f\n", matter.effect, plan->de00_p95, missed, left);
  EXPECT_GT(missed, 1) << "it matters here";
  EXPECT_LT(left, 0.5 * missed) << "drawing it is worth it";
  EXPECT_LT(missed, 2 * plan->de00_p95);
  EXPECT_GT(missed, 0.5 * plan->de00_p95);
}

INSTANTIATE_TEST_SUITE_P(Plan, Estimates, testing::ValuesIn(where_it_matters()),
                         [](const auto& matter) { return std::string(matter.param.effect); });

// The control is the textbook's form: every lobe looks along the mirror direction, its cosine that of its middle.
TEST(HorizonAndCosine, LightComesFromWhereTheLobeGathersIt) {
  const Room& room = shared_room();
  const double white = diffuse_white(&room.env, {}).luminance;
  Scene scene;
  scene.mesh = &room.mesh, scene.env = &room.env;
  scene.paints = {wide_flakes()};
  double error[2];
  for (const bool horizon : {false, true}) {
    Effects effects = effects_of(scene);
    effects.horizon = horizon;
    auto renderer = Renderer::create();
    ASSERT_TRUE(renderer->load(scene, effects, "cpu").ok());
    Frame frame;
    ASSERT_TRUE(renderer->draw(room.view, frame).ok());
    error[horizon] = picture_error(frame, scene, &room.source, white, kChecked, 1).de00_mean;
  }
  std::printf("mean dE00: %.2f along the mirror direction, %.2f\n", error[0], error[1]);
  EXPECT_LT(error[1], error[0] / 2);
}

}  // namespace
}  // namespace goniochrome::render::estimates_test
