// The light of a floor from a grid, against paths that know no grid.
#include "render/path/shaded_ground.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "math/statistics.h"
#include "render/internal/seen.h"
#include "render/path/scenes_for_paths_for_test.h"

namespace goniochrome::render::shaded_ground_test {
namespace {

// A sky with a sun, and ground of many colors.
envmap::Environment meadow() {
  return environment_of(64, 32, [](int x, int y) {
    const double sun = x == 20 && y == 8 ? 900 : 0;
    if (y >= 16) return color::Rgb{0.2 + 0.1 * (x % 7), 0.5, 0.1 + 0.05 * (y % 5)};
    return color::Rgb{0.3 + 0.005 * x + sun, 0.5 + sun, 0.9 + 0.9 * sun};
  });
}

// A white box on four stilts, as a car is.
mesh::Mesh box_above_floor() {
  mesh::Mesh box = box_mesh(true);
  for (auto& t : box.triangles) std::swap(t[1], t[2]);  // facing outward
  for (Vec3& n : box.normals) n = -n;
  mesh::Mesh all;
  add_mesh(all, box, 1, {0, 0, 0});
  for (Vec3& p : all.positions) p = {p.x, 0.3 + 0.4 * (p.y + 1), 2 * p.z};
  for (const double x : {-0.8, 0.8})
    for (const double z : {-1.6, 1.6}) {
      mesh::Mesh leg = box;
      for (Vec3& p : leg.positions) p = {x + 0.1 * p.x, 0.16 * (p.y + 1), z + 0.1 * p.z};
      add_mesh(all, leg, 1, {0, 0, 0});
    }
  return all;
}

struct Stage : PathStage {
  Stage() : PathStage(box_above_floor(), {matt({0.7, 0.6, 0.5})}) {
    environment = meadow();
    ground.emplace();
    ground->height = 0, ground->probe_eye = {0, 0.6, 0};
    scene.lights = {{normalized({-1, 0.8, 0.4}), {0.3, 0.3, 0.2}, 0.05}};
    build();
  }
};

TEST(ShadedGround, ShowsWhatPathsShow) {
  const Stage stage;
  constexpr int kBounces = 4;
  // The transport of pictures, and one with eight times as many directions of light that the mesh sends.
  Transport shaded = *stage.transport, finer = *stage.transport;
  shaded.shade_ground({}, kBounces);
  finer.shade_ground({.bounced_directions = 2048}, kBounces);
  PathOptions options;
  options.bounces = kBounces;
  std::vector<double> errors, finer_errors, control;
  double bias = 0;
  constexpr int kPoints = 120;
  for (int i = 0; i < kPoints; ++i) {
    // Spirals out from under the box; the far ones lie where cells are large.
    const double turn = 2.399963 * i, radius = 0.3 + 6.0 * i * i / (kPoints * kPoints);
    const Vec3 at{radius * std::sin(turn), 0, radius * std::cos(turn)};
    const PathEstimate truth = stage.seen(options, at + Vec3{0, 0.05, 0}, at, 256);
    const rays::Float3 from = shaded.rays().local(at + Vec3{0, 0.05, 0}), down{0, -1, 0};
    const rays::Hit hit = shaded.rays().closest(from, down);
    if (hit.triangle != rays::kFloor) continue;  // within a leg
    const rays::Spot spot = shaded.rays().spot(hit, from, down);
    const color::Rgb seen = shaded.shaded_ground(spot).sum(), open = shaded.open_ground(spot);
    const double noise = noise_de00(truth.radiance, truth.covariance, 1);
    errors.push_back(std::max(0.0, seen_difference(seen, truth.radiance, 1) - 2 * noise));
    finer_errors.push_back(
        std::max(0.0, seen_difference(finer.shaded_ground(spot).sum(), truth.radiance, 1) - 2 * noise));
    control.push_back(seen_difference(open, truth.radiance, 1));
    bias += (seen.y - truth.radiance.y) / kPoints;
  }
  EXPECT_LT(percentile_95(errors), 1);
  EXPECT_LT(percentile_95(finer_errors), 0.5);
  ASSERT_GT(errors.size(), 0.9 * kPoints);
  EXPECT_LT(std::abs(bias), 0.002);
  EXPECT_GT(percentile_95(control), 10) << "the control: the floor in the open";
}

// Light that the mesh sends is compared with that of 8192 directions at the same nodes: it errs by less than the
// tolerance. What is left is the error of independent directions, of which 16 times as many have a quarter; a third is
// allowed for the error of the 8192. Control: 64 directions.
TEST(ShadedGround, LightThatTheMeshSendsErrsLessTheMoreDirectionsItHas) {
  const Stage stage;
  const auto shaded_by = [&](int directions, std::uint64_t seed = 1) {
    Transport shaded = *stage.transport;
    shaded.shade_ground({.cell = 1.0 / 40, .bounced_directions = directions, .seed = seed}, 2);
    return shaded;
  };
  const Transport truth = shaded_by(1 << 13);
  const auto error_with = [&](int directions) {
    std::vector<double> errors;
    for (const std::uint64_t seed : {2, 3, 4}) {
      const Transport shaded = shaded_by(directions, seed);
      for (int i = 0; i < 400; ++i) {
        const double turn = 2.399963 * i, radius = 1.2 + 0.01 * i;
        const Vec3 at{radius * std::sin(turn), 0, 1.6 * radius * std::cos(turn)};
        const rays::Float3 from = truth.rays().local(at + Vec3{0, 0.05, 0}), down{0, -1, 0};
        const rays::Spot spot = truth.rays().spot(truth.rays().closest(from, down), from, down);
        errors.push_back(seen_difference(shaded.shaded_ground(spot).sum(), truth.shaded_ground(spot).sum(), 1));
      }
    }
    return percentile_95(errors);
  };
  constexpr double kCoarse = 2, kFine = 0.125;
  const double coarse = error_with(ground_directions(kCoarse)), fine = error_with(ground_directions(kFine));
  EXPECT_LT(coarse, kCoarse);
  EXPECT_LT(fine, kFine);
  EXPECT_LT(fine, coarse / 3);
  EXPECT_GT(error_with(64), kFine) << "the control must fail";
}

// More directions cost more time and err less. What is left is compared with a sum over 16384 directions, at the same
// nodes.
TEST(ShadedGround, ErrsLessTheMoreDirectionsItHas) {
  constexpr double kCell = 0.05;
  const Stage stage;
  const auto lit = [&](const Transport& shaded, const Vec3& at) {
    const rays::Float3 from = shaded.rays().local(at + Vec3{0, 0.05, 0}), down{0, -1, 0};
    return shaded.shaded_ground(shaded.rays().spot(shaded.rays().closest(from, down), from, down)).direct;
  };
  Transport truth = *stage.transport;
  truth.shade_ground({.directions = 1 << 14, .cell = kCell}, 0);
  double before = 1;
  for (const double tolerance : {2.0, 0.125}) {
    Transport shaded = *stage.transport;
    const int directions = ground_directions(tolerance);
    shaded.shade_ground({.directions = directions, .cell = kCell}, 0);
    std::vector<double> errors;
    for (int i = 0; i < 400; ++i) {
      const double turn = 2.399963 * i, radius = 1.2 + 0.01 * i;
      const Vec3 at{radius * std::sin(turn), 0, 1.6 * radius * std::cos(turn)};
      errors.push_back(seen_difference(lit(shaded, at), lit(truth, at), 1));
    }
    const double error = percentile_95(errors);
    EXPECT_LT(error, std::max(0.5 * tolerance, 0.05)) << directions;
    EXPECT_LT(error, 0.35 * before);
    before = error;
  }
}

// Without time for twice the directions, the grid is that of the fewest. The control has all that are asked for.
TEST(ShadedGround, ATimeLimitTakesDirections) {
  constexpr double kNoTime_s = 1e-3, kCell = 0.05;
  const Stage stage;
  const rays::Float3 down{0, -1, 0};
  const auto light = [&](const GroundRequest& request) {
    Transport shaded = *stage.transport;
    shaded.shade_ground(request, 1);
    const rays::Float3 from = shaded.rays().local({1.2, 0.05, 0.3});
    return shaded.shaded_ground(shaded.rays().spot(shaded.rays().closest(from, down), from, down)).sum();
  };
  constexpr int kFew = kFewestGroundDirections;
  const color::Rgb few = light({.directions = kFew, .cell = kCell, .bounced_directions = 4 * kFew});
  const auto many = [&](double longest_s) {
    return light({.directions = 8 * kFew, .cell = kCell, .bounced_directions = 32 * kFew, .longest_s = longest_s});
  };
  EXPECT_EQ(many(kNoTime_s), few);
  EXPECT_NE(many(0), few);
}

// Points of the body see the floor through the grid, and the light of the ground that it hides is drawn with what is
// shown in its place: the sums are those of paths.
TEST(ShadedGround, LightsTheBodyAsPathsDo) {
  const Stage stage;
  Transport shaded = *stage.transport;
  shaded.shade_ground({}, 4);
  for (const bool correction : {true, false}) {
    PathOptions options;
    options.bounces = 4, options.correction = correction;
    for (const Vec3& at : {Vec3{1, 0.5, 0.3}, Vec3{1, 0.4, -1.2}, Vec3{-1, 0.9, 0.7}, Vec3{0.2, 0.6, 2}}) {
      const Vec3 outward = std::abs(at.x) == 1 ? Vec3{at.x, 0.1, 0.2} : Vec3{0.1, 0.2, 1};
      const PathEstimate truth = stage.seen(options, at + 0.5 * outward, at, 4096);
      const rays::Float3 from = shaded.rays().local(at + 0.5 * outward),
                         toward = rays::float3(normalized(-1.0 * outward));
      const rays::Hit hit = shaded.rays().closest(from, toward);
      ASSERT_TRUE(hit.any());
      const PathEstimate read =
          path_estimate(shaded, options, shaded.rays().spot(hit, from, toward), normalized(outward), 4096, 2);
      for (int c = 0; c < 3; ++c) {
        const double noise = std::hypot(deviation(truth, c), deviation(read, c));
        EXPECT_NEAR(read.radiance[c], truth.radiance[c], 4 * noise + 0.003)
            << at.x << " " << at.y << " " << at.z << ", channel " << c << ", " << correction;
        EXPECT_LT(noise, 0.02);
      }
      // The purpose of the grid is less noise in corrections. A whole sum has that of the light above the horizon
      // either way, which differs by a few percent from seed to seed.
      EXPECT_LT(deviation(read), (correction ? 0.7 : 1.05) * deviation(truth));
    }
  }
}

// A small sun in a smooth coat is found by one direction in a million, which tells nothing of the light at its node: no
// place is far brighter than those beside it. The mean is that of paths which do not see it in the coat.
TEST(ShadedGround, ASunInPaintLeavesNoBrightPlace) {
  struct Ball : PathStage {
    explicit Ball(bool sun_in_coat) : PathStage(sphere_mesh(32), {matt({0.3, 0.3, 0.3})}) {
      for (Vec3& p : mesh.positions) p.y += 1.1;
      scene.paints.front().coat_index = 1.5;
      scene.paints.front().lobes.push_back({paint::kMirrorExponent, {}, {1, 1, 1}});
      environment = environment_of(256, 128, [](int x, int y) {
        return x == 80 && y == 30 ? color::Rgb{14000, 14000, 14000} : color::Rgb{0.5, 0.5, 0.5};
      });
      if (!sun_in_coat) mirrored = even_environment({0.5, 0.5, 0.5});
      ground.emplace();
      ground->height = 0, ground->probe_eye = {0, 0.6, 0};
      build();
    }
  };
  const Ball stage(true), without_sun(false);
  const auto shaded_by = [&](std::uint64_t seed, int bounces) {
    Transport shaded = *stage.transport;
    shaded.shade_ground({.cell = 1.0 / 40, .bounced_directions = 128, .seed = seed}, bounces);
    return shaded;
  };
  const auto seen = [](const Transport& shaded, const Vec3& at) {
    const rays::Float3 from = shaded.rays().local({at.x, 0.001, at.z}), down{0, -1, 0};
    const rays::Spot spot =
        shaded.rays().spot({rays::kFloor, 0, 0, shaded.rays().floor_distance(from, down)}, from, down);
    return shaded.shaded_ground(spot).sum().y / shaded.open_ground(spot).y;
  };
  double brightest = 0;
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    const Transport with = shaded_by(seed, 1), without = shaded_by(seed, 0);
    for (double x = -3; x <= 3; x += 0.15)
      for (double z = -3; z <= 3; z += 0.15)
        brightest = std::max(brightest, seen(with, {x, 0, z}) - seen(without, {x, 0, z}));
  }
  EXPECT_LT(brightest, 0.1);
  const Transport shaded = shaded_by(5, 1), matt = shaded_by(5, 0);
  PathOptions options;
  options.bounces = 1;
  double bias = 0, control = 0;
  constexpr int kPoints = 60;
  for (int i = 0; i < kPoints; ++i) {
    const double turn = 2.399963 * i, radius = 0.2 + 0.04 * i;
    const Vec3 at{radius * std::sin(turn), 0, radius * std::cos(turn)};
    const double truth = without_sun.seen(options, at + Vec3{0, 0.05, 0}, at, 256).radiance.y,
                 open = without_sun.seen(options, {at.x + 300, 0.05, at.z}, {at.x + 300, 0, at.z}, 16).radiance.y;
    bias += (seen(shaded, at) - truth / open) / kPoints, control += (seen(matt, at) - truth / open) / kPoints;
  }
  EXPECT_LT(std::abs(bias), 0.004);
  EXPECT_LT(control, -0.01) << "without the light that the ball sends";
}

// A leg hides all of the light; far away the mesh hides next to none.
TEST(ShadedGround, IsWholeUnderTheBodyAndFarFromIt) {
  const Stage stage;
  Transport shaded = *stage.transport;
  shaded.shade_ground({}, 0);
  const auto shown = [&](const Vec3& at) {
    const rays::Float3 from = shaded.rays().local(at + Vec3{0, 0.001, 0}), down{0, -1, 0};
    const rays::Spot spot =
        shaded.rays().spot({rays::kFloor, 0, 0, shaded.rays().floor_distance(from, down)}, from, down);
    return shaded.shaded_ground(spot).sum().y / shaded.open_ground(spot).y;
  };
  EXPECT_LT(shown({0.8, 0, 1.6}), 1e-5) << "within a leg";
  EXPECT_GT(shown({300, 0, 50}), 0.9999);
  EXPECT_GT(shown({60, 0, 50}), 0.999);
}

}  // namespace
}  // namespace goniochrome::render::shaded_ground_test
