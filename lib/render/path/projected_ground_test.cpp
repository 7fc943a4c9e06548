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

// Light that comes to the open floor from one side of a plane, by the rays and by the texels, of which each is a
// constant patch.
TEST(ProjectedGround, SharesItsLightAmongDirections) {
  const envmap::Environment sky = sunny();
  const auto ground = ProjectedGround::create(ground_at(0), sky, {});
  ASSERT_TRUE(ground.ok());
  ASSERT_TRUE(ground->has_bright());
  const Vec3 plane = normalized({1, 0.4, -0.3});
  color::Rgb left, all;
  constexpr int kParts = 8;
  for (int row = 0; row < 16 * kParts; ++row) {
    const double low = std::cos(kPi * (row + 1) / (32.0 * kParts)), high = std::cos(kPi * row / (32.0 * kParts));
    for (int column = 0; column < 64 * kParts; ++column) {
      const float* rgb = sky.radiance(column / kParts, row / kParts);
      const color::Rgb light = kPi / (64 * kParts) * (high * high - low * low) * color::Rgb{rgb[0], rgb[1], rgb[2]};
      all += light;
      if (dot(sky.direction_at((column + 0.5) / kParts, (row + 0.5) / kParts), plane) > 0) left += light;
    }
  }
  color::Rgb shared, whole;
  for (const auto& rays : {ground->soft_rays(1024), ground->bright_rays(64)}) {
    for (const ProjectedGround::SharedRay& ray : rays) {
      EXPECT_GT(ray.direction.y, 0);
      whole += ray.share;
      if (dot(ray.direction, plane) > 0) shared += ray.share;
    }
  }
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(whole[c], 1, 1e-6);
    EXPECT_NEAR(all[c], ground->irradiance()[c], 1e-6 * all[c]);
    EXPECT_NEAR(shared[c], left[c] / all[c], 0.005) << "channel " << c;
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
        if (transport.rays().occluded(transport.rays().local(at + Vec3{0, 1e-5, 0}), rays::float3(direction))) continue;
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
  }
}

}  // namespace
}  // namespace goniochrome::render::projected_ground_test
