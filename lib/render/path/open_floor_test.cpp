// The light of an open floor, against sums over all directions and against paths.
#include "render/path/open_floor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "math/statistics.h"
#include "render/path/scenes_for_paths_for_test.h"
#include "render/path/traced_paint.h"

namespace goniochrome::render::open_floor_test {
namespace {

using rays::Float3;
using rays::float3;

// Ground with a bright patch.
color::Rgb ground(const Float3& direction) {
  const double bright = rays::dot(direction, rays::normalized({1, -0.7F, 0.4F})) > 0.96F ? 8 : 0;
  return {0.4 + 0.3 * static_cast<double>(direction.x) + bright, 0.5 + bright, 0.6 + bright};
}

// With a shadow in the middle.
color::Rgb left(const Float3& place) {
  const double dark = std::exp(-3.0 * static_cast<double>(place.x * place.x + place.z * place.z));
  return {1 - 0.9 * dark, 1 - 0.8 * dark, 1 - 0.7 * dark};
}

struct Floor {
  mesh::Mesh mesh = box_mesh(true);
  rays::RayScene scene = rays::RayScene::create(mesh, rays::Floor{-1.2}).value();
  Float3 eye = scene.local({0.2, 0.6, 0});
  OpenFloor open{scene, eye, ground, ground, left};

  color::Rgb lit(const Float3& from, const Float3& direction) const {
    const Float3 place = from + scene.floor_distance(from, direction) * direction;
    return ground(rays::normalized(place - eye)) * left(place);
  }
};

paint::LobeFit metallic() {
  paint::LobeFit paint = matt({0.2, 0.1, 0.05});
  paint.lobes = {{1.3, {0.1, 0.2, 0.1}, {}},
                 {6, {0.3, 0.3, 0.2}, {}},
                 {20, {0.5, 0.5, 0.6}, {0.2, 0.2, 0.2}},
                 {90, {1, 0.9, 0.8}, {1, 1, 1}}};
  return paint;
}

// By 50,000 directions.
color::Rgb reference(const Floor& floor, const PaintedPoint& point, const Float3& from, double* size) {
  constexpr int kRows = 160, kColumns = 320;
  color::Rgb sum;
  for (int row = 0; row < kRows; ++row) {
    const double y = -(row + 0.5) / kRows, ring = std::sqrt(1 - y * y);
    for (int column = 0; column < kColumns; ++column) {
      const double turn = 2 * kPi * (column + 0.5) / kColumns;
      const Float3 direction = float3(Vec3{ring * std::sin(turn), y, ring * std::cos(turn)});
      const Reflection reflection = point.at(direction);
      if (!(reflection.pdf > 0)) continue;
      const color::Rgb f = 2 * kPi / (kRows * kColumns) * rays::vec3(reflection.f_cos);
      sum += f * (floor.lit(from, direction) - ground(direction));
      *size += (f * floor.lit(from, direction)).y;
    }
  }
  return sum;
}

// Points at heights above the floor of `low` to `high`, and what the sum over blocks is off by, beside the light of the
// floor.
struct Errors {
  std::vector<Float3> points;
  std::vector<double> errors, control;  // control: without the floor
};
Errors errors_of_blocks(const Floor& floor, double low, double high) {
  const TracedPaint paint = TracedPaint::create(metallic(), 45, {}).value();
  std::mt19937 random(7);
  std::uniform_real_distribution<float> unit(-1, 1);
  Errors found;
  constexpr std::size_t kPoints = 40;
  while (found.errors.size() < kPoints) {
    const Float3 way{unit(random), unit(random), unit(random)}, view{unit(random), 0.6F * unit(random), unit(random)};
    const Float3 normal = rays::normalized(way), viewer = rays::normalized(view);
    if (rays::dot(normal, viewer) < 0.1F) continue;
    const double x = unit(random), height = low + (high - low) * std::abs(unit(random));
    const Float3 from = floor.scene.local({x, -1.2 + height, unit(random)});
    const PaintedPoint point(paint, normal, viewer);
    const auto lobes = point.wide_lobes(100, GroundReceiver::kMostLobes).value();
    EXPECT_EQ(lobes.size(), 4U);
    GroundReceiver receiver{from, normal, viewer, point.mirrored(), static_cast<float>(point.coat_index())};
    for (const PaintedPoint::WideLobe& lobe : lobes) receiver.exponents[receiver.lobes++] = lobe.exponent;
    const GroundColumns columns = floor.open.columns(receiver);
    color::Rgb told = rays::vec3(point.diffuse()) * rays::vec3(columns.diffuse);
    for (std::size_t j = 0; j < lobes.size(); ++j)
      told += rays::vec3(lobes[j].directional_diffuse) * rays::vec3(columns.flakes[j]) +
              rays::vec3(lobes[j].gloss) * rays::vec3(columns.gloss[j]);
    double size = 1e-3;
    const color::Rgb truth = reference(floor, point, from, &size);
    found.points.push_back(from);
    found.errors.push_back(std::abs(told.y - truth.y) / size), found.control.push_back(std::abs(truth.y) / size);
  }
  return found;
}

TEST(OpenFloor, ItsBlocksAreTheSumOverAllDirections) {
  const Floor floor;
  const Errors found = errors_of_blocks(floor, 0.25, 1.75);
  EXPECT_LT(percentile_95(found.errors), 0.012);
  EXPECT_GT(percentile_95(found.control), 0.3) << "the control: without the floor";
}

TEST(OpenFloor, ItsBlocksTellNothingToPointsJustAboveIt) {
  const Floor floor;
  const Errors near = errors_of_blocks(floor, 0.01, 0.1), far = errors_of_blocks(floor, 1, 1.75);
  const auto told = [&](const Float3& point) { return floor.open.tells(point); };
  EXPECT_TRUE(std::ranges::none_of(near.points, told));
  EXPECT_TRUE(std::ranges::any_of(far.points, told));
  std::printf("off by %.3f near by, %.3f far off\n", percentile_95(near.errors), percentile_95(far.errors));
  EXPECT_GT(percentile_95(near.errors), 2 * percentile_95(far.errors)) << "the control: by blocks all the same";
}

TEST(OpenFloor, OfADarkFloorTheHiddenLightIsMissing) {
  const Floor floor;
  const OpenFloor dark(floor.scene, floor.eye, ground, ground, [](const Float3&) { return color::Rgb{}; });
  const GroundReceiver wall{floor.scene.local({2, 0, 0}), {1, 0, 0}, {0.6F, 0.8F, 0}, {0.6F, -0.8F, 0}};
  const float lit = floor.open.columns(wall).diffuse.y, missing = dark.columns(wall).diffuse.y;
  EXPECT_LT(missing, -0.5F);
  EXPECT_LT(missing, lit - 0.5F) << "the control: a lit floor";
  // Rounding leaves a little less than nothing.
  const OpenFloor less(floor.scene, floor.eye, ground, ground, [](const Float3&) { return color::Rgb{-1e-8, 0, 0}; });
  EXPECT_NEAR(less.columns(wall).diffuse.x, dark.columns(wall).diffuse.x, 1e-5F);
  EXPECT_EQ(dark.lit(wall.position, {0.6F, -0.8F, 0}, 0, 0).y, 0);
}

TEST(OpenFloor, MapsHoldMeansOverEqualParts) {
  const Floor floor;
  double all = 0;
  constexpr int kSize = 64;
  for (int row = 0; row < kSize; ++row)
    for (int column = 0; column < kSize; ++column)
      if (HemisphereMap::place(static_cast<float>(column) + 0.5F, static_cast<float>(row) + 0.5F, kSize).below)
        all += HemisphereMap::texel_sr(kSize);
  EXPECT_NEAR(all, 2 * kPi, 0.01 * 2 * kPi);
  for (const Vec3& way : {Vec3{0, -1, 0}, Vec3{-0.9, -0.3, 0.2}, Vec3{-0.5, -0.5, -0.7}, Vec3{0.1, -0.02, 1}}) {
    const Float3 direction = float3(normalized(way));
    EXPECT_NEAR(floor.open.hidden(direction, 0, 0).x, ground(direction).x, 0.01);
    EXPECT_NEAR(floor.open.hidden(direction, 0.1F, 0.5F).y, ground(direction).y, 0.2);
  }
  // A part that holds all of the patch has its light.
  const Float3 patch = rays::normalized({1, -0.7F, 0.4F});
  EXPECT_NEAR(floor.open.hidden(patch, 0, 0).y, 8.5F, 1e-4F);
  EXPECT_LT(floor.open.hidden(patch, 4, 0).y, 5);
}

// A plate over the ground and under it nothing: the light of the ground less that of the environment is what paths tell
// with and without a floor. Brushed paint has no blocks.
TEST(OpenFloor, CorrectionsAreTheLightOfPaths) {
  for (const bool brushed : {false, true}) {
    mesh::Mesh plate;
    add_rectangle(plate, "plate", {-0.5, 0, 0}, {1, 0, 0}, {0, 1, 0});
    paint::LobeFit paint = metallic();
    paint.lobes.push_back({900, {}, {40, 40, 40}});
    PathStage stage(plate, {paint}), open(plate, {paint});
    if (brushed) stage.scene.anisotropy = open.scene.anisotropy = {{0.1, 0.3}};
    stage.environment = open.environment = environment_of(64, 32, [](int x, int y) {
      return y < 16 ? color::Rgb{0.5, 0.6, 0.7}
                    : color::Rgb{0.2, 0.3, 0.1} + (y > 21 ? 2.0 + x % 4 : 0.0) * color::Rgb{1, 1, 1};
    });
    stage.ground.emplace();
    stage.ground->height = -0.3, stage.ground->probe_eye = {0, 1, 0.4};
    stage.build(), open.build();
    Transport shaded = *stage.transport;
    shaded.shade_ground({}, 0);
    PathOptions plain, correction;
    plain.bounces = correction.bounces = 0;
    correction.correction = true;
    const Vec3 eye{0.4, 0.9, 2}, target{0.1, 0.5, 0};
    constexpr int kBatches = 4000;
    const PathEstimate with = stage.seen(plain, eye, target, kBatches),
                       without = open.seen(plain, eye, target, kBatches);
    const Vec3 toward = normalized(target - eye);
    const Float3 from = shaded.rays().local(eye), direction = float3(toward);
    const PathEstimate told =
        path_estimate(shaded, correction, shaded.rays().spot(shaded.rays().closest(from, direction), from, direction),
                      -toward, 200, 1);
    const color::Rgb truth = with.radiance - without.radiance;
    const double noise = std::hypot(std::hypot(deviation(with), deviation(without)), deviation(told));
    EXPECT_NEAR(told.radiance.y, truth.y, 4 * noise + 0.01 * with.radiance.y) << brushed;
    EXPECT_GT(std::abs(truth.y), 0.05 * with.radiance.y) << "the control: without the correction";
    const double most = (brushed ? 0.5 : 0.05) * with.radiance.y;
    EXPECT_LT(deviation(told) * std::sqrt(200.0), most) << "of a batch";
  }
}

// The floor under a roof in a sun, in the mirror of a plate.
TEST(OpenFloor, AFloorInAMirrorIsKnownWithoutSamples) {
  mesh::Mesh mesh;
  add_rectangle(mesh, "mirror", {-4, -1, -2}, {8, 0, 0}, {0, 3, 0});
  add_rectangle(mesh, "roof", {-8, 2.2, -1.9}, {14, 0, 0}, {0, 0, 6});
  PathStage stage(std::move(mesh), {only_mirror(0.9), matt({0.3, 0.3, 0.3})});
  stage.environment = environment_of(64, 32, [](int x, int y) {
    return y == 2 && x == 20 ? color::Rgb{4000, 4000, 4000} : color::Rgb{0.5 + 0.1 * (x % 3), 0.6, y / 32.0};
  });
  stage.ground.emplace();
  stage.ground->height = -1.2, stage.ground->probe_eye = {0, 1, 0.4};
  stage.build();
  Transport shaded = *stage.transport;
  shaded.shade_ground({}, 0);
  PathOptions options;
  options.bounces = 0;
  const Float3 from = shaded.rays().local({2, 2.5, 6});
  double least = 1;
  for (const double x : {-2.0, -1.5, -1.0, -0.5, 0.0}) {
    const Float3 direction = rays::normalized(shaded.rays().local({x, 0.2, -2}) - from);
    const rays::Hit hit = shaded.rays().closest(from, direction);
    ASSERT_EQ(shaded.rays().part(hit.triangle), 0);
    const rays::Spot spot = shaded.rays().spot(hit, from, direction);
    const PointTransport known(shaded, options, spot, -direction);
    ASSERT_TRUE(known.certain());
    const PathEstimate truth = path_estimate(*stage.transport, options, spot, rays::vec3(-direction), 2000, 1);
    const double noise = deviation(truth);
    const Float3 mirrored = direction - 2 * rays::dot(direction, spot.shading) * spot.shading;
    const rays::Spot floor = shaded.rays().spot(shaded.rays().closest(spot.start, mirrored), spot.start, mirrored);
    least = std::min(least, shaded.shaded_ground(floor).direct.y / shaded.open_ground(floor).y);
    EXPECT_NEAR(known.deterministic().y, truth.radiance.y, 4 * noise + 0.05 * truth.radiance.y) << x;
  }
  EXPECT_LT(least, 0.7) << "the control: an open floor";
}

}  // namespace
}  // namespace goniochrome::render::open_floor_test
