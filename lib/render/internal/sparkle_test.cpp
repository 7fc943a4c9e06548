// Flakes of a picture: their mean, their spread, and where they are not drawn.
#include "render/internal/sparkle.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/angles.h"
#include "base/parallel.h"
#include "brdf/lobe_model.h"
#include "render/internal/seen.h"
#include "render/plan/sparkle_plan.h"
#include "render/scene_effects.h"
#include "render/scenes_for_test.h"

namespace goniochrome::render::sparkle_test {
namespace {

using testing::HasSubstr;

// A plate in the plane z = 0, of a square meter or of four, in front of which a camera stands at a distance in meters.
// Each pixel shows as many micrometers.
struct Panel {
  mesh::Mesh mesh = panels_mesh(1);
  envmap::PrefilteredEnvironment env;
  Scene scene;
  Gbuffer gbuffer;

  Panel(double distance_m, double pixel_um, int pixels, double view_deg = 0) {
    mesh.unit_m = 1;
    if (1e-6 * pixel_um * pixels > 0.6)
      for (Vec3& corner : mesh.positions) corner = 2 * corner;
    paint::LobeFit paint = matt({0.05, 0.05, 0.05});
    paint.lobes = {{20, {0.6, 0.5, 0.4}, {}}, {100, {1, 1, 1.5}, {}}};
    scene.mesh = &mesh;
    scene.paints = {paint};
    scene.flakes = {paint::KnownFlakes{{30, 0.5, 0.5}, false}};
    const double t = view_deg * kDegree;
    Camera camera;
    camera.eye = {distance_m * std::sin(t), 0, distance_m * std::cos(t)};
    camera.target = {0, 0, 0}, camera.up = {0, 1, 0};
    camera.fov_deg = 2 * std::atan(0.5e-6 * pixel_um * pixels / distance_m) / kDegree;
    gbuffer = seen_by_rays(mesh, camera, pixels, pixels);
  }
  Panel(const Panel&) = delete;

  void lit_by_sun(double apart_deg) {
    Light sun;
    sun.direction = normalized({std::sin(apart_deg * kDegree), 0.02, std::cos(apart_deg * kDegree)});
    sun.white = {1, 0.95, 0.9}, sun.radius_rad = 0.265 * kDegree;
    scene.lights = {sun};
  }
  Effects effects() const { return effects_of(scene); }
  // Stands for what an engine draws without the effect.
  image::Image mean() const {
    image::Image picture{gbuffer.width, gbuffer.height, 4, {}, {"R", "G", "B", "A"}};
    for (int y = 0; y < gbuffer.height; ++y)
      for (int x = 0; x < gbuffer.width; ++x) {
        color::Rgb sum{0.01, 0.01, 0.01};
        for (const Light& light : scene.lights)
          sum += kPi * std::max(0.0, light.direction.z) * light.white *
                 brdf::brdf(scene.paints[0], light.direction, gbuffer.to_viewer(x, y), {0, 0, 1});
        for (int c = 0; c < 3; ++c) picture.data.push_back(static_cast<float>(sum[c]));
        picture.data.push_back(1);
      }
    return picture;
  }
  image::Image drawn() const {
    image::Image picture = mean();
    Sparkle(scene, effects()).add(gbuffer, nullptr, picture);
    return picture;
  }
};

struct Statistics {
  color::Rgb mean;
  double contrast = 0;  // of luminance
};
Statistics statistics_of(const image::Image& picture) {
  Statistics s;
  const double pixels = static_cast<double>(picture.data.size()) / 4;
  double squares = 0;
  for (std::size_t i = 0; i < picture.data.size(); i += 4) {
    const color::Rgb rgb{picture.data[i], picture.data[i + 1], picture.data[i + 2]};
    s.mean += (1 / pixels) * rgb;
    squares += std::pow(color::xyz_d65_from_rgb(rgb).Y, 2) / pixels;
  }
  const double mean = color::xyz_d65_from_rgb(s.mean).Y;
  s.contrast = std::sqrt(std::max(0.0, squares / (mean * mean) - 1));
  return s;
}

// From so far that the mean of 10^4 pixels has a standard error of 0.02 dE00.
TEST(Sparkle, KeepsTheMeanColor) {
  Panel panel(10, 10000, 100);
  panel.lit_by_sun(12);
  const Statistics with = statistics_of(panel.drawn()), without = statistics_of(panel.mean());
  EXPECT_GT(with.contrast, without.contrast + 0.005) << "there is grain";
  EXPECT_LT(seen_difference(with.mean, without.mean, 1), 0.05);
  // Near by, single flakes differ more: four standard errors.
  Panel near(0.3, 200, 100);
  near.lit_by_sun(12);
  const Statistics flakes = statistics_of(near.drawn()), plain = statistics_of(near.mean());
  EXPECT_GT(flakes.contrast, 1);
  EXPECT_NEAR(color::xyz_d65_from_rgb(flakes.mean).Y / color::xyz_d65_from_rgb(plain.mean).Y, 1,
              4 * flakes.contrast / 100);
}

// The plan needs no drawing to know what the effect is worth; within what 10^4 pixels tell of a skewed spread.
TEST(Sparkle, PredictsItsContrast) {
  for (const double view_deg : {0.0, 40.0, 70.0})
    for (const double pixel_um : {300.0, 2000.0}) {
      Panel panel(20, pixel_um, 100, view_deg);
      panel.lit_by_sun(-view_deg + 10);
      const image::Image mean = panel.mean();
      const float* middle = mean.pixel(50, 50);
      const color::Rgb shown{middle[0], middle[1], middle[2]};
      const color::Rgb deviation = Sparkle(panel.scene, panel.effects()).deviation(panel.gbuffer, 50, 50, shown);
      const double predicted = color::xyz_d65_from_rgb(deviation).Y / color::xyz_d65_from_rgb(shown).Y;
      const double found = statistics_of(panel.drawn()).contrast;
      EXPECT_NEAR(found / predicted, 1, 0.05 + 4 * predicted / 100) << view_deg << " deg, " << pixel_um << " um";
    }
}

// Many lamps are drawn together, and vary as much as each by itself would.
TEST(Sparkle, PredictsTheContrastOfManyLamps) {
  Panel panel(20, 3000, 100);
  panel.lit_by_sun(10);
  const Light sun = panel.scene.lights[0];
  for (int i = 1; i < 8; ++i) {
    Light lamp = sun;
    lamp.direction = normalized({0.2 * std::cos(i), 0.2 * std::sin(i), 1});
    panel.scene.lights.push_back(lamp);
  }
  const image::Image mean = panel.mean();
  const float* middle = mean.pixel(50, 50);
  const color::Rgb shown{middle[0], middle[1], middle[2]};
  const color::Rgb deviation = Sparkle(panel.scene, panel.effects()).deviation(panel.gbuffer, 50, 50, shown);
  const double predicted = color::xyz_d65_from_rgb(deviation).Y / color::xyz_d65_from_rgb(shown).Y;
  const Statistics found = statistics_of(panel.drawn());
  EXPECT_NEAR(found.contrast / predicted, 1, 0.05);
  EXPECT_NEAR(found.mean.y / statistics_of(mean).mean.y, 1, 4 * predicted / 100);
}

// A view from afar shows the mean of what one from near by shows of a patch.
TEST(Sparkle, ShowsTheSameFlakesFromNearAndFar) {
  Panel near(50, 500, 80), far(50, 1000, 40);
  near.lit_by_sun(10), far.lit_by_sun(10);
  const image::Image fine = near.drawn(), coarse = far.drawn(), fine_mean = near.mean(), coarse_mean = far.mean();
  double product = 0, of_fine = 0, of_coarse = 0, turned = 0;
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x) {
      double a = 0;
      for (int i = 0; i < 4; ++i) {
        const int u = 2 * x + i % 2, v = 2 * y + i / 2;
        a += 0.25 * (fine.pixel(u, v)[1] - fine_mean.pixel(u, v)[1]);
      }
      const double b = coarse.pixel(x, y)[1] - coarse_mean.pixel(x, y)[1],
                   c = coarse.pixel(y, x)[1] - coarse_mean.pixel(y, x)[1];
      product += a * b, of_fine += a * a, of_coarse += b * b, turned += a * c;
    }
  EXPECT_GT(product / std::sqrt(of_fine * of_coarse), 0.9);
  EXPECT_LT(std::abs(turned) / std::sqrt(of_fine * of_coarse), 0.2) << "other flakes are no measure";
}

double correlation(const image::Image& a, const image::Image& a_mean, const image::Image& b,
                   const image::Image& b_mean) {
  double product = 0, of_a = 0, of_b = 0;
  for (std::size_t i = 1; i < a.data.size(); i += 4) {
    const double x = a.data[i] - a_mean.data[i], y = b.data[i] - b_mean.data[i];
    product += x * y, of_a += x * x, of_b += y * y;
  }
  return product / std::sqrt(of_a * of_b);
}

// Ten frames of a turn: a frame drawn again is the same, a small turn leaves most flakes lit, a large one lights
// others, and the mean over all frames stays.
TEST(Sparkle, FlakesFlashInATurnThatKeepsTheMean) {
  Panel panel(0.3, 200, 60);
  double drawn = 0, mean = 0, squares = 0;
  image::Image before, before_mean;
  for (int frame = 0; frame < 10; ++frame) {
    panel.lit_by_sun(8 + 3 * frame);
    const image::Image now = panel.drawn(), now_mean = panel.mean();
    EXPECT_EQ(now.data, panel.drawn().data);
    const Statistics of_frame = statistics_of(now);
    drawn += 0.1 * of_frame.mean.y, mean += 0.1 * statistics_of(now_mean).mean.y;
    squares += 0.01 * std::pow(of_frame.contrast * of_frame.mean.y, 2) / 3600;
    if (frame > 0) {
      EXPECT_LT(correlation(now, now_mean, before, before_mean), 0.2);
    }
    panel.lit_by_sun(8.05 + 3 * frame);
    EXPECT_GT(correlation(now, now_mean, panel.drawn(), panel.mean()), 0.8);
    before = now, before_mean = now_mean;
  }
  EXPECT_NEAR(drawn, mean, 4 * std::sqrt(squares));
}

TEST(Sparkle, IsNothingUnderAnEvenSky) {
  Panel panel(0.3, 200, 40);
  panel.env = constant_env({1, 1, 1}, {20, 100});
  for (envmap::PrefilteredLobe& lobe : panel.env.lobes) lobe.rms = std::make_shared<envmap::CubeMap>(lobe.map);
  panel.scene.env = &panel.env;
  EXPECT_EQ(panel.drawn().data, panel.mean().data);
  EXPECT_EQ(Sparkle(panel.scene, panel.effects()).deviation(panel.gbuffer, 20, 20, {1, 1, 1}), color::Rgb{});
  // The control: where the squares say that the light is uneven, there is grain, and its size is that of the squares.
  for (envmap::PrefilteredLobe& lobe : panel.env.lobes)
    lobe.rms = std::make_shared<envmap::CubeMap>(cube_of(4, [](const Vec3&) { return Vec3{1.5, 1.5, 1.5}; }));
  const image::Image mean = panel.mean(), drawn = panel.drawn();
  EXPECT_NE(drawn.data, mean.data);
  // The squares alone are the light of this picture: the mean of 0.01 limits what flakes can have of it.
  EXPECT_NEAR(statistics_of(drawn).mean.x / statistics_of(mean).mean.x, 1, 0.02);
  const double contrast = std::sqrt(1.25 / (paint::Flakes{30, 0.5, 0.5}.per_m2() * 200e-6 * 200e-6));
  EXPECT_GT(statistics_of(drawn).contrast, 0.4 * contrast);
  EXPECT_LT(statistics_of(drawn).contrast, 2 * contrast);
}

TEST(Sparkle, IsTheSameForAnyNumberOfThreads) {
  Panel panel(0.3, 300, 60);
  panel.lit_by_sun(8);
  set_threads(1);
  const image::Image one = panel.drawn();
  set_threads(4);
  const image::Image four = panel.drawn();
  set_threads(0);
  EXPECT_EQ(one.data, four.data);
  EXPECT_NE(one.data, panel.mean().data);
}

// A second plate stands between the first and the sun, and the lesser lamps beside it.
TEST(Sparkle, FlakesInTheShadowDoNotShowTheSun) {
  Panel panel(0.3, 200, 40);
  panel.lit_by_sun(30);
  for (const double part : {0.3, 0.2}) {
    Light lesser = panel.scene.lights[0];
    lesser.direction = normalized(lesser.direction + Vec3{0, 0.1 * part, 0}), lesser.white = part * lesser.white;
    panel.scene.lights.push_back(lesser);
  }
  mesh::Mesh shaded = panel.mesh;
  const auto first = static_cast<std::uint32_t>(shaded.positions.size());
  for (const Vec3& corner : panel.mesh.positions) shaded.positions.push_back(0.3 * corner + Vec3{0.29, 0, 0.4});
  shaded.normals.insert(shaded.normals.end(), panel.mesh.normals.begin(), panel.mesh.normals.end());
  for (const auto& t : panel.mesh.triangles) shaded.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  shaded.parts.push_back({"screen", "", 2, 2});
  const auto blockers = rays::RayScene::create(shaded);
  ASSERT_TRUE(blockers.ok());
  image::Image picture = panel.mean();
  Sparkle(panel.scene, panel.effects()).add(panel.gbuffer, &*blockers, picture);
  EXPECT_EQ(picture.data, panel.mean().data);
  EXPECT_NE(panel.drawn().data, panel.mean().data) << "the sun would be seen";
}

// A pixel has fewer than one flake, of which few are lit: the mean stays, and most pixels have none.
TEST(Sparkle, APixelOfLessThanOneFlakeKeepsTheMean) {
  Panel panel(0.3, 25, 100);
  panel.lit_by_sun(0);
  panel.scene.flakes[0]->flakes = {30, 0.5, 15};
  const double flakes = panel.scene.flakes[0]->flakes.per_m2() * 25e-6 * 25e-6;
  EXPECT_LT(flakes, 1);
  const image::Image drawn = panel.drawn();
  const Statistics with = statistics_of(drawn), without = statistics_of(panel.mean());
  EXPECT_NEAR(with.mean.y / without.mean.y, 1, 4 * with.contrast / 100);
  int lit = 0;
  for (std::size_t i = 1; i < drawn.data.size(); i += 4) lit += drawn.data[i] > without.mean.y ? 1 : 0;
  EXPECT_GT(lit, 100);
  EXPECT_LT(lit, 10000 * flakes);
}

// Flakes have places in the mesh alone: texture that is mirrored or has no area, and thus no tangents, is of no matter.
TEST(Sparkle, NeedsNoTextureCoordinates) {
  Panel panel(0.3, 200, 20);
  panel.lit_by_sun(10);
  const image::Image without = panel.drawn();
  for (const float side : {-1.0F, 0.0F}) {
    panel.mesh.texture.clear();
    for (const Vec3& at : panel.mesh.positions)
      panel.mesh.texture.push_back({side * static_cast<float>(at.x), static_cast<float>(at.y)});
    EXPECT_EQ(panel.drawn().data, without.data) << side;
  }
}

// Within a box whose walls are on all sides, one of which is behind the eye.
TEST(Sparkle, ACameraInsideTheBoxOfTheMeshSeesItsFlakes) {
  Panel panel(0.3, 200, 40);
  mesh::Mesh& mesh = panel.mesh;
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const Vec3& corner : {Vec3{-0.5, -0.5, 0.5}, {0.5, -0.5, 0.5}, {0.5, 0.5, 0.5}, {-0.5, 0.5, 0.5}}) {
    mesh.positions.push_back(corner), mesh.normals.push_back({0, 0, -1});
  }
  mesh.triangles.push_back({first, first + 2, first + 1}), mesh.triangles.push_back({first, first + 3, first + 2});
  mesh.parts[0].count = 4;
  panel.lit_by_sun(10);
  Camera camera;
  camera.eye = {0, 0, 0.3}, camera.target = {0, 0, 0}, camera.up = {0, 1, 0};
  camera.fov_deg = 2 * std::atan(0.5e-6 * 200 * 40 / 0.3) / kDegree;
  panel.gbuffer = seen_by_rays(mesh, camera, 40, 40);
  Panel open(0.3, 200, 40);
  open.lit_by_sun(10);
  EXPECT_EQ(panel.drawn().data, open.drawn().data);
  EXPECT_NE(panel.drawn().data, panel.mean().data);
}

// Every drawn pixel is finite and not negative.
TEST(Sparkle, HoldsInHardCases) {
  for (const double exposure : {1e-6, 1.0, 1e6})
    for (const double view_deg : {0.0, 85.0, 89.9})
      for (const paint::Flakes flakes : {paint::Flakes{1000, 1e-4, 0}, {0.01, 1, 0.5}, {30, 0.5, 30}}) {
        Panel panel(0.05, 50, 12, view_deg);
        panel.lit_by_sun(-view_deg);
        panel.scene.flakes[0]->flakes = flakes;
        panel.scene.lights[0].white = exposure * color::Rgb{1, 1, 1};
        Light point = panel.scene.lights[0];
        point.radius_rad = 0, point.place = Light::Place{{0, 0, 0.02}, 1};
        panel.scene.lights.push_back(point);
        for (const float value : panel.drawn().data) {
          EXPECT_TRUE(std::isfinite(value)) << exposure << " " << view_deg;
          EXPECT_GE(value, -1e-5 * exposure);
        }
      }
}

PlanItem planned(const Panel& panel, const std::string& effects, double tolerance = 0.5) {
  PlanRequest request;
  request.effects = *words_of(effects), request.tolerance_de00 = tolerance;
  const image::Image mean = panel.mean();
  std::vector<ProbePixel> pixels;
  for (int i = 0; i < panel.gbuffer.width; ++i) {
    const float* rgb = mean.pixel(i, i);
    pixels.push_back({&panel.gbuffer, i, i, {rgb[0], rgb[1], rgb[2]}});
  }
  Effects all = panel.effects();
  const PlanItem item = sparkle_item(panel.scene, pixels, request, all);
  EXPECT_EQ(all.sparkle, item.on);
  return item;
}

TEST(Sparkle, IsPlannedWhereItIsSeen) {
  Panel near(0.3, 200, 20), far(60, 40000, 20);
  near.lit_by_sun(10), far.lit_by_sun(10);
  const PlanItem drawn = planned(near, "auto"), dropped = planned(far, "auto");
  EXPECT_EQ(drawn.decision, Decision::kDrawn);
  EXPECT_GT(drawn.de00_p95, 5);
  EXPECT_THAT(drawn.reason, HasSubstr("flakes of 30 um, coverage 0.5"));
  EXPECT_THAT(drawn.reason, HasSubstr("and this is 0.3 m"));
  EXPECT_EQ(dropped.decision, Decision::kDropped);
  EXPECT_EQ(planned(far, "auto,+sparkle").decision, Decision::kForcedOn);
  EXPECT_EQ(planned(near, "auto,-sparkle").decision, Decision::kForcedOff);
  EXPECT_FALSE(planned(near, "none").on);
  near.scene.flakes[0]->assumed = true;
  EXPECT_THAT(planned(near, "auto").reason, HasSubstr("(assumed by class)"));
  for (const char* effects : {"auto", "all"}) {
    const PlanItem unstated = planned(near, effects);
    EXPECT_EQ(unstated.decision, Decision::kDropped) << "nobody stated them";
    EXPECT_TRUE(std::isnan(unstated.de00_p95)) << "nor are they measured";
  }
  EXPECT_EQ(planned(near, "auto,+sparkle").decision, Decision::kForcedOn);
}

// The plan predicts without drawing what flakes change where they are drawn, about the distance up to which they are.
TEST(Sparkle, ThePredictionIsTheTrueChange) {
  for (const double distance_m : {10.0, 20.0, 35.0}) {
    Panel panel(distance_m, 1000 * distance_m, 30);
    panel.lit_by_sun(10);
    const image::Image mean = panel.mean();
    std::vector<ProbePixel> pixels;
    for (int i = 0; i < 900; i += 7) {
      const float* rgb = mean.pixel(i % 30, i / 30);
      pixels.push_back({&panel.gbuffer, i % 30, i / 30, {rgb[0], rgb[1], rgb[2]}});
    }
    const double truth = sparkle_truth(panel.scene, panel.effects(), pixels, 1);
    EXPECT_NEAR(truth / planned(panel, "auto").de00_p95, 1, 0.35) << distance_m << " m";
  }
}

TEST(Sparkle, SaysWhyItIsNotDrawn) {
  Panel panel(0.3, 200, 10);
  EXPECT_THAT(planned(panel, "auto").reason, HasSubstr("no light"));
  panel.lit_by_sun(10);
  panel.scene.anisotropy = {{0.1, 0.3}};
  EXPECT_EQ(planned(panel, "auto").reason, "no visible paint has flakes; left out on brushed parts");
  panel.scene.anisotropy = {};
  panel.scene.flakes = {std::nullopt};
  EXPECT_EQ(planned(panel, "auto").reason, "no visible paint has flakes");
  EXPECT_EQ(sparkle_left_out(panel.scene, "path").decision, Decision::kNotInScene);
  panel.scene.flakes = {paint::KnownFlakes{}};
  EXPECT_EQ(sparkle_left_out(panel.scene, "path").decision, Decision::kDropped);
  panel.gbuffer.triangles.clear();
  EXPECT_THAT(planned(panel, "auto").reason, HasSubstr("buffers without their mesh"));
  panel.scene.lights = {};
  panel.env = constant_env({1, 1, 1}, {20, 100});
  Panel sky(0.3, 200, 10);
  sky.scene.env = &panel.env;
  EXPECT_THAT(planned(sky, "auto").reason, HasSubstr("prefilter-envmap --sparkle"));
}

}  // namespace
}  // namespace goniochrome::render::sparkle_test
