// Tilted lobes in pictures: by both engines with prefiltered maps, against the integral of the color map, and in plans.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/testdata_for_test.h"
#include "brdf/tilted_lobes.h"
#include "envmap/environment.h"
#include "fit/color_map_fit.h"
#include "fit/paint_fit.h"
#include "fit/tilt_fit.h"
#include "formats/paint_source.h"
#include "prefilter/prefilter.h"
#include "render/cpu/cpu_engine.h"
#include "render/exact.h"
#include "render/internal/tilt_table.h"
#include "render/picture_error.h"
#include "render/renderer.h"
#include "render/scene_effects.h"
#include "render/scenes_for_test.h"

namespace goniochrome::render::tilts_test {
namespace {

using testing::HasSubstr;

const formats::Basis kBasis = {"b5", {1.3, 6, 20, 70, 250}, false};

// A softbox overhead, a colored window and a dim room.
envmap::Environment studio() {
  image::Image image{128, 64, 3, {}, {}};
  for (int row = 0; row < 64; ++row) {
    for (int column = 0; column < 128; ++column) {
      Vec3 value{0.25, 0.24, 0.22};
      if (row > 8 && row < 20 && column > 50 && column < 75) value = {9, 9, 8.5};
      if (row > 22 && row < 36 && column > 100 && column < 112) value = {2, 2.6, 3.4};
      if (row > 40) value = {0.1, 0.09, 0.08};
      for (int c = 0; c < 3; ++c) image.data.push_back(static_cast<float>(value[c]));
    }
  }
  return *envmap::Environment::from_lat_long(std::move(image), envmap::Environment::BadPixels::kError, "studio");
}

// A sphere in a paint of thin-film flakes, with its map and its sets.
struct World {
  World() : source(studio()) {
    const paint::Paint paint = formats::read_paints(testdata("travel.paints.xml"))->back();
    map = fit::fit_color_map(*paint.measurement, {.size = 64})->map;
    tilted = fit::PaintFitter(kBasis, {}).fit(paint)->lobes;
    fit::TiltOptions options;
    options.lookups = {8, 16};
    tilted.tilts = fit::fit_tilts(map, tilted, kBasis, options).sets;
    prefilter::PrefilterRequest request;
    request.exponents = kBasis.exponents;
    env =
        prefilter::prefiltered(source, request, prefilter::prefilter_plan(source, request), [](const auto&, double) {});
    scene.mesh = &mesh, scene.env = &env, scene.paints = {tilted};
    layer = std::make_unique<SurfaceLayer>(scene, std::vector<PartSurface>{{{}, &map}}, brdf::CriticalAngle::kSlide);
    scene.layer = layer.get();
  }
  Frame drawn(const Effects& effects, const std::string& engine) const {
    auto renderer = Renderer::create();
    const auto loaded = renderer->load(scene, effects, engine);
    EXPECT_TRUE(loaded.ok()) << (loaded.ok() ? "" : loaded.error().message);
    return *renderer->draw(Camera::orbit(mesh, 30, 20, 1, 30, 1), 64, 64, 1, true);
  }
  PictureError error(int level) const {
    Effects effects = effects_of(scene);
    effects.tilt_level = level;
    return picture_error(drawn(effects, "cpu"), scene, &source, 1, 150, 3);
  }

  envmap::Environment source;
  mesh::Mesh mesh = sphere_mesh(96);
  brdf::ColorMap map;
  paint::LobeFit tilted;
  envmap::PrefilteredEnvironment env;
  Scene scene;
  std::unique_ptr<SurfaceLayer> layer;
};
const World& world() {
  static const World made;
  return made;
}

TEST(Tilts, CloseInOnTheIntegralOfTheMap) {
  ASSERT_EQ(world().tilted.tilts.size(), 2u);
  const PictureError lobes = world().error(0), coarse = world().error(1), fine = world().error(2);
  EXPECT_LE(fine.de00_mean, 1.5);
  EXPECT_LE(fine.de00_p95, 5);
  EXPECT_LT(fine.de00_mean, coarse.de00_mean);
  EXPECT_LT(coarse.de00_mean, 0.5 * lobes.de00_mean);
  // The control: lobes about the mirror direction alone.
  EXPECT_GT(lobes.de00_mean, 3);
  EXPECT_GT(lobes.de00_p95, 5);
}

// An operator that multiplies channel by channel changes nothing.
TEST(Tilts, AreMultipliedByTheOperatorAsWell) {
  Effects effects = effects_of(world().scene);
  const Frame plain = world().drawn(effects, "cpu");
  effects.reflection = true;
  const Frame by_operator = world().drawn(effects, "cpu");
  double most = 0, mean = 0;
  for (std::size_t i = 0; i < plain.picture.data.size(); ++i) {
    most = std::max(most, std::abs(static_cast<double>(plain.picture.data[i]) - by_operator.picture.data[i]));
    mean += plain.picture.data[i] / static_cast<double>(plain.picture.data.size());
  }
  EXPECT_LT(most, 1e-5 * mean);
}

TEST(Tilts, AreNotDrawnByOpenGl) {
  auto renderer = Renderer::create();
  ASSERT_TRUE(renderer.ok());
  Effects effects = effects_of(world().scene);
  const auto loaded = renderer->load(world().scene, effects, "gl");
  ASSERT_FALSE(loaded.ok());
  EXPECT_THAT(loaded.error().message, HasSubstr("draws no tilted lobes"));
  effects.tilt_level = 0;
  EXPECT_TRUE(renderer->load(world().scene, effects, "gl").ok());
}

// Even light shows the sum of the weights, which is the albedo, at any view.
TEST(Tilts, EvenLightShowsTheSumOfTheWeights) {
  Scene scene;
  const mesh::Mesh mesh = sphere_mesh(8);
  const envmap::PrefilteredEnvironment env = constant_env({1, 1, 1}, {6, 70});
  scene.mesh = &mesh, scene.env = &env;
  paint::LobeFit paint = matt({0.5, 0.5, 0.5});
  paint.tilts = {{0, {{6, -40, 30}, {70, 20, 0}}, {}}};
  paint.tilts[0].views = {{0, {0.01, 0.02, 0.03}, {{0.1, 0.2, 0.3}, {0.3, 0.1, 0}}},
                          {90, {0.03, 0.02, 0.01}, {{0.3, 0.2, 0.1}, {0, 0, 0.1}}}};
  scene.paints = {paint};
  CpuEngine engine;
  ASSERT_TRUE(engine.load(scene, effects_of(scene)).ok());
  for (const double view_deg : {0.0, 1e-4, 0.3, 10.0, 45.0, 80.0, 89.9, 89.999}) {
    const double t = view_deg * kDegree;
    const auto colors = engine.colors({{{0, 1, 0}, {-std::sin(t), std::cos(t), 0}, 0}});
    const paint::TiltedView view = brdf::at_view(paint.tilts[0], view_deg);
    const color::Rgb expected = kPi * view.diffuse + view.weights[0] + view.weights[1];
    // Weights are linear in the root of the cosine within a segment: near the normal the view changes by 10 deg in one.
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(colors[0][c], expected[c], 0.01) << view_deg;
  }
}

// The light of a point in even white light by its finest set.
double evenly_lit(const VisiblePoint& point, const paint::LobeFit& paint) {
  const double view_deg = std::acos(dot(point.normal, point.to_viewer)) / kDegree;
  const paint::TiltedView view = brdf::at_view(paint.tilts.back(), view_deg);
  double sum = kPi * view.diffuse.y;
  for (const color::Rgb& weight : view.weights) sum += weight.y;
  return sum;
}

// All light comes from below the tangent plane of the point: the map sends none of it on.
TEST(Tilts, HardlyLeakLightFromBelowTheHorizon) {
  Scene scene = world().scene;
  for (paint::Lobe& lobe : scene.paints[0].lobes) lobe.gloss = {};
  image::Image image{64, 32, 3, {}, {}};
  for (int row = 0; row < 32; ++row)
    for (int i = 0; i < 64 * 3; ++i) image.data.push_back(row < 16 ? 0.0F : 1.0F);
  const auto below =
      *envmap::Environment::from_lat_long(std::move(image), envmap::Environment::BadPixels::kError, "below");
  prefilter::PrefilterRequest request;
  request.exponents = kBasis.exponents;
  const auto env =
      prefilter::prefiltered(below, request, prefilter::prefilter_plan(below, request), [](const auto&, double) {});
  scene.env = &env;
  CpuEngine engine;
  Effects effects = effects_of(scene), untilted = effects;
  untilted.tilt_level = 0, untilted.horizon = false;
  untilted.coat = false;  // which the map has in it, and which lets little light out at grazing views
  for (const double view_deg : {10.0, 45.0, 75.0, 89.0, 89.9}) {
    const double t = view_deg * kDegree;
    const std::vector<VisiblePoint> point = {{{0, 1, 0}, {-std::sin(t), std::cos(t), 0}, 0}};
    ASSERT_TRUE(engine.load(scene, effects).ok());
    const double leaked = engine.colors(point)[0].y;
    const double even = evenly_lit(point[0], scene.paints[0]);
    // At 75 deg a third of a lobe of exponent 6 about the mirror direction lies below.
    EXPECT_LT(leaked, (view_deg < 80 ? 0.06 : 0.25) * even) << view_deg;
    ASSERT_TRUE(engine.load(scene, untilted).ok());
    if (view_deg > 80 && view_deg < 89.5) {
      EXPECT_GT(engine.colors(point)[0].y, 1.5 * leaked) << view_deg;  // the control
    }
    EXPECT_EQ(exact_radiance(point, scene, effects, &below)[0].y, 0);
  }
}

// The reference evaluates the map: a sum over a lat-long grid that shares no code with it but the map.
TEST(Tilts, TheReferenceIntegratesTheMapItself) {
  Scene scene = world().scene;
  scene.paints[0].lobes.clear();  // of gloss too
  const VisiblePoint point{{0, 0, 1}, normalized({-0.5, 0, 0.8}), 0};
  Effects effects = effects_of(scene);
  EXPECT_TRUE(effects.image_maps);
  const color::Rgb seen = exact_radiance({point}, scene, effects, &world().source)[0];
  color::Rgb sum;
  const envmap::Environment& env = world().source;
  constexpr int kFine = 4;
  for (int row = 0; row < kFine * env.height(); ++row) {
    for (int column = 0; column < kFine * env.width(); ++column) {
      const double y = (row + 0.5) / kFine, x = (column + 0.5) / kFine;
      const Vec3 d = env.direction_at(x, y);
      if (d.z <= 0) continue;
      const float* light = env.radiance(column / kFine, row / kFine);
      const double sr = env.solid_angle(x - 0.5 / kFine, y - 0.5 / kFine, x + 0.5 / kFine, y + 0.5 / kFine);
      sum += sr * d.z / kPi *
             (color::Rgb{light[0], light[1], light[2]} *
              brdf::reflectance_factor(world().map, d, point.to_viewer, brdf::CriticalAngle::kSlide));
    }
  }
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen[c], sum[c], 0.01 * sum[c]);  // texels of 3 deg, cut in four
  // By lobes it would be another color.
  effects.image_maps = false;
  EXPECT_GT(length(exact_radiance({point}, world().scene, effects, &world().source)[0] - seen), 0.05 * length(seen));
}

TEST(Tilts, ThePlanChoosesBetweenTheSets) {
  auto renderer = Renderer::create();
  const View view{Camera::orbit(world().mesh, 30, 20, 1, 30, 1), 96, 96, 1, false};
  const auto seen = renderer->look(world().mesh, view);
  ASSERT_TRUE(seen.ok());
  const auto level = [&](const PlanRequest& request) {
    const auto plan = renderer->load(world().scene, {*seen}, request);
    EXPECT_TRUE(plan.ok()) << (plan.ok() ? "" : plan.error().message);
    return plan->effects.tilt_level;
  };
  PlanRequest request;
  request.engine = "cpu";
  EXPECT_EQ(level(request), 2);
  request.tolerance_de00 = 40;
  EXPECT_EQ(level(request), 0);
  request.tolerance_de00 = 0.5, request.effects = {Start::kAuto, {{"tilts-2", false}}};
  EXPECT_EQ(level(request), 1);
  request.effects = {Start::kAuto, {{"tilts", false}}};
  EXPECT_EQ(level(request), 0);
  request.effects = {Start::kNone, {{"tilts-2", true}}};
  EXPECT_EQ(level(request), 2);
  request.effects = {Start::kAll};
  const auto plan = renderer->load(world().scene, {*seen}, request);
  ASSERT_TRUE(plan.ok());
  const auto item = std::ranges::find(plan->items, "tilts-1", &PlanItem::effect);
  ASSERT_NE(item, plan->items.end());
  EXPECT_GT(item->de00_p95, 3);
  EXPECT_THAT(item->reason, HasSubstr("tilted look-ups"));
  // The lobes that the sets stand for are not looked up.
  for (const Effects::LobeUse& use : plan->effects.lobes) EXPECT_FALSE(use.directional_diffuse);
}

// A gray paint beside a tilted one is drawn by the same bits as without.
TEST(Tilts, PaintsWithoutSetsKeepTheirBits) {
  Scene scene = world().scene;
  const mesh::Mesh panels = panels_mesh(2);
  paint::LobeFit gray = matt({0.2, 0.2, 0.2});
  gray.lobes = {{20, {0.1, 0.1, 0.1}, {}}};
  scene.mesh = &panels, scene.layer = nullptr, scene.paints = {world().tilted, gray};
  std::vector<VisiblePoint> points;
  for (double t = 0; t < 1.5; t += 0.05) points.push_back({{0, 0, 1}, {std::sin(t), 0, std::cos(t)}, 1});
  CpuEngine engine;
  Effects effects = effects_of(scene);
  ASSERT_EQ(effects.tilt_level, 2);
  ASSERT_TRUE(engine.load(scene, effects).ok());
  const auto with = engine.colors(points);
  effects.tilt_level = 0;
  ASSERT_TRUE(engine.load(scene, effects).ok());
  EXPECT_EQ(engine.colors(points), with);
  for (VisiblePoint& point : points) point.part = 0;
  const auto lobes = engine.colors(points);
  effects.tilt_level = 2;
  ASSERT_TRUE(engine.load(scene, effects).ok());
  EXPECT_NE(engine.colors(points), lobes);  // the control
}

TEST(Tilts, AMapOfALobeThatIsMissingIsNamed) {
  Scene scene = world().scene;
  envmap::PrefilteredEnvironment env = world().env;
  std::erase_if(env.lobes, [](const auto& lobe) { return lobe.exponent == 6; });
  scene.env = &env;
  CpuEngine engine;
  const auto loaded = engine.load(scene, effects_of(scene));
  ASSERT_FALSE(loaded.ok());
  EXPECT_THAT(loaded.error().message, HasSubstr("no lobe of exponent 6"));
}

}  // namespace
}  // namespace goniochrome::render::tilts_test
