// Bright spots against exact sums over the texels, and against the same pictures without them.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "envmap/open_maps.h"
#include "prefilter/prefilter.h"
#include "render/exact.h"
#include "render/internal/seen.h"
#include "render/path/scenes_for_paths_for_test.h"
#include "render/picture_error.h"
#include "render/renderer.h"
#include "render/scene_effects.h"

namespace goniochrome::render::spots_test {
namespace {

const std::vector<double> kExponents = {1.3, 6, 20, 900};

// A low sun and a window in a dim hall.
envmap::Environment hall() {
  return environment_of(256, 128, [](int x, int y) {
    const bool sun = std::abs(x - 60) < 2 && std::abs(y - 50) < 2;
    const bool window = x > 150 && x < 166 && y > 30 && y < 60;
    const double light = sun ? 600 : window ? 12 : 0;
    return color::Rgb{0.2 + light, 0.22 + 0.9 * light, 0.25 + 0.7 * light};
  });
}

envmap::PrefilteredEnvironment maps_of(const envmap::Environment& environment) {
  prefilter::PrefilterRequest request;
  request.exponents = kExponents, request.tolerance = 1e-4;
  return prefilter::prefiltered(environment, request, prefilter::prefilter_plan(environment, request),
                                [](const envmap::PrefilteredLobe&, double) {});
}

paint::LobeFit metallic(bool coated) {
  paint::LobeFit paint = matt({0.15, 0.16, 0.2});
  paint.lobes = {
      {1.3, {0.06, 0.06, 0.07}, {}}, {6, {0.3, 0.3, 0.3}, {}}, {20, {0.3, 0.3, 0.35}, {}}, {900, {}, {9, 9, 9}}};
  if (coated) paint.coat_index = 1.5;
  return paint;
}

struct Hall {
  envmap::Environment environment = hall();
  envmap::PrefilteredEnvironment env = maps_of(environment);
  mesh::Mesh mesh = sphere_mesh(64);
  Scene scene;
  View view{Camera::orbit(mesh, 30, 20, 0.9, 30, 1), 64, 64, 1, true};

  explicit Hall(bool coated = false) { scene.mesh = &mesh, scene.paints = {metallic(coated)}, scene.env = &env; }
  Hall(const Hall&) = delete;

  Frame drawn(const Effects& effects, const std::string& engine) const {
    auto renderer = Renderer::create();
    EXPECT_TRUE(renderer.ok());
    EXPECT_TRUE(renderer->load(scene, effects, engine).ok());
    Frame frame;
    EXPECT_TRUE(renderer->draw(view, frame).ok());
    return frame;
  }
  double error_p95(const Effects& effects, const std::string& engine) const {
    const double white = diffuse_white(&env, {}).luminance;
    return picture_error(drawn(effects, engine), scene, &environment, white, 400, 1).de00_p95;
  }
};

// The control is the picture without them, whose lobes do not know on which side of the horizon the sun is.
TEST(Spots, ArePicturesOfTheExactSum) {
  for (const bool coated : {false, true}) {
    const Hall hall(coated);
    const Effects all = effects_of(hall.scene);
    EXPECT_GE(all.spots, 2U);
    Effects without = all;
    without.spots = 0;
    const double error = hall.error_p95(all, "cpu"), control = hall.error_p95(without, "cpu");
    EXPECT_LT(error, 0.6) << coated;
    EXPECT_GT(control, 3 * error) << coated;
  }
}

TEST(Spots, AreTheSameInBothEnginesOfMaps) {
  const Hall hall(true);
  const Effects all = effects_of(hall.scene);
  const Frame cpu = hall.drawn(all, "cpu"), gl = hall.drawn(all, "gl");
  std::vector<double> apart;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const float *a = cpu.picture.pixel(x, y), *b = gl.picture.pixel(x, y);
      apart.push_back(seen_difference({a[0], a[1], a[2]}, {b[0], b[1], b[2]}, 1));
    }
  EXPECT_LT(*std::ranges::max_element(apart), 0.05);
}

// In a world without horizons nothing is changed: maps and lamps have the light of the maps.
TEST(Spots, MapsLoseWhatTheLampsGive) {
  const Hall hall;
  const envmap::PrefilteredLobe& lobe = *hall.env.lobe(6);
  const envmap::CubeMap rest = envmap::without_spots(lobe.map, 6, hall.env.spots);
  double most = 0, negative = 0;
  for (std::size_t i = 0; i < rest.texels.size(); ++i) {
    most = std::max<double>(most, rest.texels[i]);
    negative = std::min<double>(negative, rest.texels[i]);
  }
  const double before = *std::ranges::max_element(lobe.map.texels);
  EXPECT_LT(most, 0.2 * before) << "the spots are taken out";
  EXPECT_GT(negative, -0.01 * before) << "and no more than they give";
}

// Files keep the maps without spots as halves; the control is a picture without spots.
TEST(Spots, PicturesOfKeptMapsAreThoseOfMadeMaps) {
  const auto folder = std::filesystem::temp_directory_path() / fmt::format("goniochrome-spots-{}", getpid());
  std::filesystem::create_directories(folder);
  const std::string path = (folder / "kept.env.exr").string();
  Hall hall(true);
  const Effects all = effects_of(hall.scene);
  const Frame made = hall.drawn(all, "cpu");
  Effects without = all;
  without.spots = 0;
  const Frame control = hall.drawn(without, "cpu");
  envmap::keep_open_maps(hall.env);
  EXPECT_EQ(hall.drawn(all, "cpu").picture.data, made.picture.data) << "maps in memory are the same to the last bit";
  for (envmap::PrefilteredLobe* lobe : {&hall.env.lobes[0], &hall.env.lobes[1]}) EXPECT_NE(lobe->open, nullptr);
  for (envmap::PrefilteredLobe& lobe : hall.env.lobes) lobe.tolerance = 1e-3;  // halves
  hall.env.diffuse.tolerance = 1e-3;
  ASSERT_TRUE(envmap::write_env(path, hall.env, "test").ok());
  auto read = envmap::read_env(path);
  std::filesystem::remove_all(folder);
  ASSERT_TRUE(read.ok());
  // Only the kept maps are those of the file.
  for (std::size_t i = 0; i < hall.env.lobes.size(); ++i) hall.env.lobes[i].open = read->lobes[i].open;
  hall.env.diffuse.open = read->diffuse.open, hall.env.open_coat_diffuse = read->open_coat_diffuse;
  const Frame kept = hall.drawn(all, "cpu");
  const auto most = [&](const Frame& of) {
    double largest = 0;
    for (std::size_t i = 0; i < made.picture.data.size(); ++i)
      largest = std::max<double>(
          largest, std::abs(of.picture.data[i] - made.picture.data[i]) / std::max(0.01F, made.picture.data[i]));
    return largest;
  };
  EXPECT_NE(kept.picture.data, made.picture.data) << "halves were read";
  EXPECT_LE(most(kept), 0x1p-10);
  EXPECT_GT(most(control), 0x1p-6);
}

TEST(Spots, APlanLeavesThemOutWhereTheyAreNotSeen) {
  Hall hall;
  const auto planned = [&](const EffectWords& effects) {
    auto renderer = Renderer::create();
    EXPECT_TRUE(renderer.ok());
    const auto seen = renderer->look(hall.mesh, hall.view);
    PlanRequest request;
    request.effects = effects, request.white_luminance = diffuse_white(&hall.env, {}).luminance;
    auto plan = renderer->load(hall.scene, {*seen}, request);
    EXPECT_TRUE(plan.ok());
    return *std::move(plan);
  };
  const auto item = [](const Plan& plan) { return *std::ranges::find(plan.items, "spots", &PlanItem::effect); };
  Plan plan = planned({});
  EXPECT_EQ(item(plan).decision, Decision::kDrawn);
  EXPECT_GT(item(plan).de00_p95, 1);
  EXPECT_EQ(plan.effects.spots, hall.env.spots.size());
  plan = planned({Start::kAuto, {{"spots", false}}});
  EXPECT_EQ(item(plan).decision, Decision::kForcedOff);
  EXPECT_EQ(plan.effects.spots, 0U);
  plan = planned({Start::kAuto, {{"horizon", false}}});
  EXPECT_EQ(plan.effects.spots, 0U) << "they need it";
  hall.scene.paints = {matt({0.5, 0.5, 0.5})};
  plan = planned({});
  EXPECT_EQ(item(plan).decision, Decision::kNotInScene) << "the diffuse map is exact";
  hall.scene.paints = {metallic(false)};
  hall.env.spots.clear();
  EXPECT_EQ(item(planned({})).reason, "no small part of the environment is bright");
}

// Rays that ask for the sun by itself find the same light in the mean, with less noise where all of the sun is hidden.
TEST(Spots, RaysFindTheSameLightWithASunOfItsOwn) {
  mesh::Mesh mesh = box_mesh(false);
  add_mesh(mesh, sphere_mesh(32), 0.5, {0.1, -0.5, 0});
  PathStage whole(mesh, {metallic(true)});
  whole.environment = environment_of(256, 128, [](int x, int y) {
    const bool sun = std::abs(x - 60) < 1 && std::abs(y - 30) < 1;
    return (sun ? 9e3 : 0.3) * color::Rgb{1, 0.9, 0.8};
  });
  const auto split = envmap::sunlit_sky(*whole.environment);
  ASSERT_TRUE(split.has_value());
  PathStage apart(mesh, {metallic(true)});
  apart.environment = split->sky;
  apart.scene.lights = {light_of(split->sun)};
  whole.build(), apart.build();
  PathOptions options;
  options.correction = true, options.bounces = 2;
  double noise_whole = 0, noise_apart = 0;
  for (const Vec3& target : {Vec3{0.1, -0.4, 0.3}, Vec3{-0.6, -1, 0.4}, Vec3{0.6, -1, -0.5}, Vec3{-1, -0.2, 0.1}}) {
    const PathEstimate a = whole.seen(options, {0.2, 2.5, 0.9}, target, 400);
    const PathEstimate b = apart.seen(options, {0.2, 2.5, 0.9}, target, 400);
    for (int c = 0; c < 3; ++c) {
      // The disc is as wide as the texels, but round: its light is cut elsewhere by the horizon and by the mesh.
      const double spread = std::hypot(deviation(a, c), deviation(b, c));
      EXPECT_NEAR(a.radiance[c], b.radiance[c], 4 * spread + 0.01 * std::abs(a.radiance[c]));
    }
    noise_whole += deviation(a), noise_apart += deviation(b);
  }
  EXPECT_LT(noise_apart, 0.5 * noise_whole);
}

}  // namespace
}  // namespace goniochrome::render::spots_test
