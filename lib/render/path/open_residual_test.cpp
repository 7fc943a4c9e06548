#include "render/path/open_residual.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "base/parallel.h"
#include "math/statistics.h"
#include "prefilter/prefilter.h"
#include "render/exact.h"
#include "render/integral/integral_engine.h"
#include "render/internal/seen.h"
#include "render/path/open_light.h"
#include "render/path/scenes_for_paths_for_test.h"
#include "render/plan.h"
#include "render/planning.h"
#include "render/renderer.h"
#include "render/scene_effects.h"

namespace goniochrome::render::open_residual_test {
namespace {

const std::vector<double> kExponents = {1.3, 6, 20, 70, 900};

// An environment and its maps.
struct Sky {
  envmap::Environment image;
  envmap::PrefilteredEnvironment maps;

  explicit Sky(const std::function<color::Rgb(int, int)>& light) : image(environment_of(128, 64, light)) {
    prefilter::PrefilterRequest request;
    request.exponents = kExponents;
    maps = prefilter::prefiltered(image, request, prefilter::prefilter_plan(image, request),
                                  [](const envmap::PrefilteredLobe&, double) {});
  }
};

// A low red sun over dark ground, with a bright window, which lobes meet that the horizon cuts.
color::Rgb dusk_at(int x, int y) {
  const double dx = (x - 40) / 6.0, dy = (y - 29) / 4.0, sun = 60 * std::exp(-dx * dx - dy * dy);
  const double sky = y < 32 ? 0.3 + 0.02 * y : 0.05, window = x > 90 && x < 100 && y > 20 && y < 30 ? 10 : 0;
  return {sky + sun + window, sky + 0.5 * sun + window, sky + 0.2 * sun + window};
}
const Sky& dusk() {
  static const Sky made(dusk_at);
  return made;
}
// The sky behind blinds, whose slats a mirror shows.
const Sky& blinds() {
  static const Sky made([](int x, int y) { return (y % 4 < 2 ? 1.6 : 0.4) * dusk_at(x, y); });
  return made;
}

// Flakes in all of the lobes, and gloss.
paint::LobeFit flakes() {
  paint::LobeFit paint = matt({0.1, 0.12, 0.2});
  for (const double exponent : kExponents) {
    const double weight = 0.04 * (exponent + 2), gloss = 0.002 * (exponent + 1);
    paint.lobes.push_back({exponent, weight * color::Rgb{0.9, 1, 0.8}, {gloss, gloss, gloss}});
  }
  return paint;
}

struct World {
  mesh::Mesh mesh = sphere_mesh(64);
  Scene scene;
  View view;
  const Sky& sky;
  envmap::BlockTree tree;

  explicit World(paint::LobeFit paint, const Sky& around = dusk()) : sky(around), tree(around.image) {
    scene.mesh = &mesh;
    scene.paints = {std::move(paint)};
    scene.env = &sky.maps;
    view = {Camera::orbit(mesh, 60, 5, 1, 30, 1), 96, 96, 1, false};
  }
  World(const World&) = delete;

  Effects effects(double tolerance_de00 = 0.5) const {
    Effects effects = effects_of(scene);
    effects.tolerance_de00 = tolerance_de00;
    return effects;
  }
  std::shared_ptr<const Gbuffer> seen() const { return *Renderer::tracing().look(mesh, view); }
};

// How far the engine cpu is from the exact sum at some points of a world, at 95 of 100 of them and in the mean, by maps
// alone and by maps and the residual.
struct Errors {
  double maps = 0, summed = 0, maps_mean = 0, summed_mean = 0;
};
Errors errors_of(const World& world, double tolerance_de00 = 0.5) {
  const Effects effects = world.effects(tolerance_de00);
  const std::vector<VisiblePoint> points = probe_points(probe_pixels({world.seen()}, 200), {}, 1);
  CpuEngine engine;
  EXPECT_TRUE(engine.load(world.scene, effects).ok());
  const std::vector<color::Rgb> drawn = engine.colors(points);
  OpenResidual residual(world.tree);
  const Result<void> loaded = residual.load(world.scene, effects);
  EXPECT_TRUE(loaded.ok()) << loaded.error().message;
  const std::vector<color::Rgb> more = residual.at(points);
  // By blocks that are ten times finer than those of the residual, relative to what they err by.
  const Surroundings around(world.tree, spread_for(0.02 * tolerance_de00));
  const std::vector<color::Rgb> exact = exact_radiance(points, world.scene, effects, around);
  const double white = diffuse_white(&world.sky.maps, {}).luminance;
  std::vector<double> by_maps, summed;
  for (std::size_t i = 0; i < points.size(); ++i) {
    by_maps.push_back(seen_difference(drawn[i], exact[i], white));
    summed.push_back(seen_difference(drawn[i] + more[i], exact[i], white));
  }
  const double maps_mean = math::mean(by_maps), summed_mean = math::mean(summed);
  return {percentile_95(std::move(by_maps)), percentile_95(std::move(summed)), maps_mean, summed_mean};
}

// Nodes and blocks are chosen for the tolerance of the whole picture, of which the open light may take this part as
// plans have it. The maps alone are the control.
constexpr double kTolerance_de00 = 0.5, kOfOpenLight = 0.8;

void expect_better(const World& world, const char* what) {
  const Errors errors = errors_of(world, kTolerance_de00);
  EXPECT_LT(errors.summed, kOfOpenLight * kTolerance_de00) << what;
  EXPECT_GT(errors.maps, 1.5 * errors.summed) << what;
}

TEST(OpenResidual, BringsWideLobesWithinTheTolerance) {
  const World world(flakes());
  EXPECT_GT(errors_of(world).maps, kTolerance_de00);
  expect_better(world, "flakes");
}

TEST(OpenResidual, TellsSurfacesOfEveryKind) {
  World coated(flakes());
  coated.scene.paints[0].coat_index = 1.6;
  expect_better(coated, "under a coat");
  World colored(flakes());
  colored.scene.reflection = color::working_space_operator();
  expect_better(colored, "by an operator");
  World traveling(flakes());
  paint::LobeFit& paint = traveling.scene.paints[0];
  paint.views = {{0, paint.diffuse, paint.lobes}, {60, 1.3 * paint.diffuse, paint.lobes}};
  for (paint::Lobe& lobe : paint.views[1].lobes)
    lobe.directional_diffuse = color::Rgb{0.9, 0.8, 1} * lobe.directional_diffuse;
  expect_better(traveling, "with weights of two views");
}

// Their tilted normals are dear to sum. The control: the same paint that is not brushed.
// The light of columns, against sums at the points themselves. The control: maps alone.
TEST(OpenLight, IsSummedWithinTheToleranceBetweenNodes) {
  const World world(flakes());
  LobeColumns columns;
  columns.exponents = kExponents;
  const OpenLight maps = *OpenLight::create(world.scene, columns, {}, {.mirror = false});
  OpenLight summed = maps;
  summed.sum(world.tree, 0.25);
  const SummedLight exact(world.tree, 0.02, columns);
  const double white = diffuse_white(&world.sky.maps, {}).luminance;
  std::vector<double> by_maps, by_nodes;
  for (const VisiblePoint& point : probe_points(probe_pixels({world.seen()}, 200), {}, 1)) {
    const Vec3 mirrored = 2 * dot(point.normal, point.to_viewer) * point.normal - point.to_viewer;
    std::vector<color::Rgb> one(columns.count()), other(columns.count()), truth(columns.count());
    maps.at(point.normal, point.to_viewer, 0, one.data());
    summed.at(point.normal, point.to_viewer, 0, other.data());
    exact.at(point.normal, point.to_viewer, {{mirrored, 1}}, paint::kNoCoat, truth.data());
    for (std::size_t k = 0; k < exact.count(); ++k) {
      const double weight = nominal_weight(columns, k);
      by_maps.push_back(seen_difference(weight * one[k], weight * truth[k], white));
      by_nodes.push_back(seen_difference(weight * other[k], weight * truth[k], white));
    }
    EXPECT_EQ(other[columns.flake(4)], one[columns.flake(4)]) << "a sharp lobe is left to its maps";
  }
  const double missed = percentile_95(std::move(by_maps)), left = percentile_95(std::move(by_nodes));
  std::printf("p95 of maps %.2f, between nodes %.2f\n", missed, left);
  EXPECT_LT(left, 0.5);
  EXPECT_GT(missed, 1.5);
}

TEST(OpenResidual, LeavesBrushedPartsAsMapsHaveThem) {
  World world(flakes());
  const std::vector<VisiblePoint> points = probe_points(probe_pixels({world.seen()}, 50), {}, 1);
  const std::vector<color::Rgb> nothing(points.size());
  for (const bool brushed : {false, true}) {
    if (brushed) world.scene.anisotropy = {{0.1, 0.3}};
    OpenResidual residual(world.tree);
    ASSERT_TRUE(residual.load(world.scene, world.effects()).ok());
    EXPECT_EQ(residual.at(points) == nothing, brushed);
    EXPECT_EQ(residual.count() == 0, brushed);
  }
}

TEST(OpenResidual, IsFinerForASmallerTolerance) {
  const World world(flakes());
  const double coarse = errors_of(world, 2).summed, fine = errors_of(world, 0.125).summed;
  EXPECT_LT(fine, coarse / 2);
  EXPECT_LT(fine, 0.125);
}

TEST(OpenResidual, IsTheSameByAnyNumberOfThreadsAndOfOtherPicturesBefore) {
  const World world(flakes());
  const auto seen = world.seen();
  const auto picture_of = [&](int count, bool after_another) {
    set_threads(count);
    OpenResidual residual(world.tree);
    EXPECT_TRUE(residual.load(world.scene, world.effects()).ok());
    if (after_another) residual.at(probe_points(probe_pixels({seen}, 40), {}, 1));
    image::Image picture{seen->width, seen->height, 4, std::vector<float>(seen->data.size(), 0.0F), {}};
    residual.add(*seen, 1, picture);
    set_threads(0);
    return picture.data;
  };
  const std::vector<float> one = picture_of(1, false);
  EXPECT_GT(*std::ranges::max_element(one), 0.01);
  EXPECT_EQ(picture_of(7, false), one);
  EXPECT_EQ(picture_of(2, true), one);
}

TEST(OpenResidual, KeepsSumsForOtherPaintsOfTheSameSurface) {
  World world(flakes());
  const std::vector<VisiblePoint> points = probe_points(probe_pixels({world.seen()}, 100), {}, 1);
  OpenResidual residual(world.tree);
  ASSERT_TRUE(residual.load(world.scene, world.effects()).ok());
  const std::vector<color::Rgb> first = residual.at(points);
  const std::size_t count = residual.count();
  world.scene.paints[0].diffuse = {0.3, 0, 0};
  ASSERT_TRUE(residual.load_paints(world.scene).ok());
  const std::vector<color::Rgb> second = residual.at(points);
  EXPECT_EQ(residual.count(), count);
  EXPECT_NE(first, second);
  OpenResidual anew(world.tree);
  ASSERT_TRUE(anew.load(world.scene, world.effects()).ok());
  EXPECT_EQ(anew.at(points), second);
  world.scene.paints[0].coat_index = 1.5;
  ASSERT_TRUE(residual.load(world.scene, world.effects()).ok());
  residual.at(points);
  EXPECT_EQ(residual.count(), 2 * count);
}

struct Drawn {
  Plan plan;
  std::vector<float> picture;
};

class Draws {
 public:
  explicit Draws(const World& world) : world_(world), renderer_(Renderer::tracing()) {
    RaySetup setup;
    setup.environment = &world_.sky.image;
    setup.absent = "left out", setup.refused = true;
    renderer_.set_rays(setup);
  }
  Drawn planned(const Scene& scene, const std::string& effects) {
    PlanRequest request;
    request.effects = *words_of(effects);
    request.white_luminance = diffuse_white(&world_.sky.maps, {}).luminance;
    auto plan = renderer_.load(scene, {*renderer_.look(world_.mesh, world_.view)}, request);
    EXPECT_TRUE(plan.ok()) << plan.error().message;
    const Frame frame = again();
    add_findings(frame.rays, frame.maps, *plan);
    return {*std::move(plan), frame.picture.data};
  }
  std::vector<float> edited(const Scene& scene) {
    renderer_.load_paints(scene);
    return again().picture.data;
  }

 private:
  Frame again() {
    Frame frame;
    EXPECT_TRUE(renderer_.draw(world_.view, frame).ok());
    return frame;
  }

  const World& world_;
  Renderer renderer_;
};

const PlanItem& sums_of(const Drawn& drawn) {
  return *std::ranges::find(drawn.plan.items, "sums", &PlanItem::effect);
}

TEST(OpenResidual, IsDrawnWhereItIsSeen) {
  const World world(flakes());
  const Drawn with = Draws(world).planned(world.scene, "auto"),
              without = Draws(world).planned(world.scene, "auto,-sums");
  EXPECT_EQ(sums_of(with).decision, Decision::kDrawn);
  EXPECT_GT(sums_of(with).de00_p95, kOfOpenLight * kTolerance_de00);
  EXPECT_EQ(sums_of(without).decision, Decision::kForcedOff);
  EXPECT_NE(with.picture, without.picture);
  // The sums have Fresnel's reflectance, which such a picture is to lack.
  EXPECT_FALSE(sums_of(Draws(world).planned(world.scene, "auto,-fresnel")).on);
}

// A mirror of blinds decides the 95th percentile of what maps miss, which sums hardly lower, while they lower the mean.
// The control: the same mirror over a solid color, to which they have little to add.
TEST(OpenResidual, IsDrawnWhereSharpLobesDecideThe95thPercentile) {
  World world(flakes(), blinds());
  std::vector<paint::Lobe>& lobes = world.scene.paints[0].lobes;
  for (paint::Lobe& lobe : lobes) lobe = {lobe.exponent, 0.4 * lobe.directional_diffuse, 0.4 * lobe.gloss};
  lobes.back() = {paint::kMirrorExponent, {}, {1, 1, 1}};
  const Errors errors = errors_of(world);
  EXPECT_GT(errors.summed, 0.95 * errors.maps);
  EXPECT_LT(errors.summed_mean, 0.8 * errors.maps_mean);
  EXPECT_EQ(sums_of(Draws(world).planned(world.scene, "auto")).decision, Decision::kDrawn);

  World sharp(matt({0.02, 0.02, 0.02}), blinds());
  sharp.scene.paints[0].lobes = {lobes.back()};
  EXPECT_GT(errors_of(sharp).maps, kOfOpenLight * kTolerance_de00);
  EXPECT_NE(sums_of(Draws(sharp).planned(sharp.scene, "auto")).decision, Decision::kDrawn);
}

// The first pass finds that nobody sees the sums: the picture is that without them, bit for bit.
TEST(OpenResidual, StopsWhereNobodySeesIt) {
  World faint(flakes());
  for (paint::Lobe& lobe : faint.scene.paints[0].lobes)
    lobe = {lobe.exponent, 1e-4 * lobe.directional_diffuse, 1e-4 * lobe.gloss};
  const Drawn by_maps = Draws(faint).planned(faint.scene, "auto");
  if (sums_of(by_maps).needed) {
    EXPECT_EQ(sums_of(by_maps).decision, Decision::kFirstPass);
    EXPECT_LE(sums_of(by_maps).de00_p95, 0.5 * kTolerance_de00);
  }
  EXPECT_EQ(by_maps.picture, Draws(faint).planned(faint.scene, "auto,-sums").picture);
  const World solid(matt({0.5, 0.4, 0.3}));
  EXPECT_FALSE(sums_of(Draws(solid).planned(solid.scene, "auto")).needed) << "its map is exact";
}

TEST(OpenResidual, FollowsEditsOfPaints) {
  const World world(flakes());
  Scene edited = world.scene;
  edited.paints[0].diffuse = {0.3, 0.05, 0.02};
  edited.paints[0].lobes[2].directional_diffuse = {2, 0.5, 0.5};
  Draws draws(world);
  const Drawn first = draws.planned(world.scene, "all,+sums");
  ASSERT_TRUE(sums_of(first).on);
  const std::vector<float> second = draws.edited(edited);
  EXPECT_EQ(second, Draws(world).planned(edited, "all,+sums").picture);
  EXPECT_EQ(draws.edited(world.scene), first.picture);
  EXPECT_NE(second, first.picture);
}

}  // namespace
}  // namespace goniochrome::render::open_residual_test
