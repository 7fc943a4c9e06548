// The light of a floor that shows the environment: how directions are drawn from it, and what a mesh takes from it.
#include "render/path/projected_ground.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/angles.h"
#include "render/path/scenes_for_paths_for_test.h"

namespace goniochrome::render::projected_ground_test {
namespace {

// A dim sky with a sun of one texel.
envmap::Environment sunny() {
  return environment_of(64, 32, [](int x, int y) {
    const double sun = x == 20 && y == 11 ? 900 : 0;
    return color::Rgb{0.3 + 0.005 * x + sun, 0.5 + sun, 0.9 + 0.9 * sun};
  });
}

Ground ground_at(double height) {
  Ground ground;
  ground.height = height, ground.probe_eye = {0, height + 1.5, 0};
  return ground;
}

// The mean of cosine by density over directions that are drawn is the integral of the cosine over the window.
TEST(ProjectedGround, DrawsEveryDirectionOfAWindowByItsDensity) {
  const envmap::Environment sky = sunny();
  const auto ground = ProjectedGround::create(ground_at(0), sky, {});
  ASSERT_TRUE(ground.ok());
  const mesh::Box box{{-1, 0, -2}, {1, 1.4, 2}};
  for (const Vec3& at : {Vec3{0, 0, 0}, Vec3{1.5, 0, 0}, Vec3{-4, 0, 3}, Vec3{0.2, 0, -9}}) {
    const ProjectedGround::Window window = ground->window(at, box);
    double sum = 0, squares = 0;
    constexpr int kDraws = 1 << 16;
    for (int i = 0; i < kDraws; ++i) {
      const auto numbers =
          Sequence(mixed(7, static_cast<std::uint64_t>(i / 16)), 16).point(static_cast<std::uint32_t>(i % 16), 0);
      const Vec3 direction = ground->drawn(window, numbers[0], numbers[1], numbers[2]);
      const double density = ground->density(window, direction);
      ASSERT_GT(density, 0);
      // Cells at the edge reach out of the window: there only the light is drawn.
      const bool inside = direction.y <= std::sin(window.top_rad) &&
                          std::abs(std::remainder(std::atan2(direction.x, direction.z) - window.azimuth_rad,
                                                  2 * kPi)) <= window.half_width_rad;
      const double value = inside ? direction.y / density : 0;
      sum += value, squares += value * value;
    }
    const double mean = sum / kDraws, error = std::sqrt((squares / kDraws - mean * mean) / kDraws);
    EXPECT_NEAR(mean, window.cosine, 4 * error) << at.x << " " << at.z;
    EXPECT_LT(error, 0.02 * window.cosine);
  }
}

// Against a sum over the texels of the sky in parts, each of which is occluded or not: black boxes send nothing back.
TEST(ProjectedGround, ShowsWhatTheMeshLeavesOfTheLight) {
  mesh::Mesh box = box_mesh(true);
  for (auto& t : box.triangles) std::swap(t[1], t[2]);  // facing outward
  for (Vec3& n : box.normals) n = -n;
  for (Vec3& p : box.positions) p.y = 0.3 + 0.4 * (p.y + 1);  // above the floor, as a car is
  PathStage stage(box, {matt({0, 0, 0})});
  stage.environment = sunny();
  stage.ground = ground_at(0);
  stage.build();
  const Transport& transport = *stage.transport;
  const auto ground = ProjectedGround::create(*stage.ground, *stage.environment, {});
  ASSERT_TRUE(ground.ok());
  constexpr int kParts = 8;
  for (const Vec3& at : {Vec3{0, 0, 0}, Vec3{1.3, 0, 0.2}, Vec3{-1.4, 0, -0.6}, Vec3{0.4, 0, 1.6}, Vec3{-3, 0, 2}}) {
    color::Rgb left;
    for (int row = 0; row < 16 * kParts; ++row) {
      const double low = std::cos(kPi * (row + 1) / (32.0 * kParts)), high = std::cos(kPi * row / (32.0 * kParts));
      const double weight = 2 * kPi / (64 * kParts) * (high * high - low * low) / 2;
      for (int column = 0; column < 64 * kParts; ++column) {
        const Vec3 direction = stage.environment->direction_at((column + 0.5) / kParts, (row + 0.5) / kParts);
        if (transport.rays().occluded(at + Vec3{0, 1e-5, 0}, direction)) continue;
        const float* rgb = stage.environment->radiance(column / kParts, row / kParts);
        left += weight * color::Rgb{rgb[0], rgb[1], rgb[2]};
      }
    }
    const color::Rgb truth = ground->paint(ground->open_radiance(at)) * left;
    PathOptions options;
    options.correction = true;
    const PathEstimate seen = stage.seen(options, at + Vec3{0, 0.2, 0}, at, 512);
    for (int c = 0; c < 3; ++c) {
      // Parts of texels at the edge of the box's shadow are occluded as a whole: 0.4 % of the open light.
      EXPECT_NEAR(seen.radiance[c], truth[c], 4 * deviation(seen, c) + 0.004 * ground->open_radiance(at)[c])
          << at.x << " " << at.z << ", channel " << c;
    }
    // The mesh can change more light than it changes.
    const double hidden = ground->light_share(ground->window(at, bounding_box(box)));
    const color::Rgb open = ground->open_radiance(at);
    EXPECT_LE(1 - seen.radiance[1] / open[1], hidden + 4 * deviation(seen, 1) / open[1] + 1e-3);
  }
}

// Far away it can change little, but for the long shadow of a low sun.
TEST(ProjectedGround, TellsWhereAMeshChangesNothing) {
  const envmap::Environment even = even_environment();
  const auto ground = ProjectedGround::create(ground_at(0), even, {});
  ASSERT_TRUE(ground.ok());
  const mesh::Box box{{-1, 0, -2}, {1, 1.4, 2}};
  EXPECT_EQ(ground->light_share(ground->window({0.5, 0, 1}, box)), 1);
  EXPECT_LT(ground->light_share(ground->window({0, 0, 40}, box)), 1e-3);
  std::vector<Light> low = {{normalized({0, 0.05, -1}), {3, 3, 3}}};
  const auto lit = ProjectedGround::create(ground_at(0), even, low);
  ASSERT_TRUE(lit.ok());
  EXPECT_GT(lit->light_share(lit->window({0, 0, 20}, box)), 0.01) << "the shadow of the light falls there";
  EXPECT_LT(lit->light_share(lit->window({0, 0, -40}, box)), 1e-3);
}

}  // namespace
}  // namespace goniochrome::render::projected_ground_test
