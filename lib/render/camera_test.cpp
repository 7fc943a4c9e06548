#include "render/camera.h"

#include <gtest/gtest.h>

#include "base/angles.h"
#include "render/scenes_for_test.h"

namespace goniochrome::render::camera_test {
namespace {

TEST(Camera, OrbitTurnsFromFrontToRightAndUp) {
  const auto near = [](const Vec3& a, const Vec3& b) { return length(a - b) < 1e-15; };
  EXPECT_TRUE(near(orbit_direction(0, 0), {0, 0, 1}));
  EXPECT_TRUE(near(orbit_direction(90, 0), {1, 0, 0}));
  EXPECT_TRUE(near(orbit_direction(180, 0), {0, 0, -1}));
  EXPECT_TRUE(near(orbit_direction(17, 90), {0, 1, 0}));
}

TEST(Camera, UpperLeftIsUpperLeft) {
  Camera camera;
  camera.eye = {0, 0, 10};
  const auto seen = rays(camera, 200, 100);
  ASSERT_TRUE(seen.ok());
  const Vec3 corner = seen->direction(0, 0), middle = seen->direction(100, 50);
  EXPECT_LT(corner.x, 0);
  EXPECT_GT(corner.y, 0);
  EXPECT_LT(length(middle - Vec3{0, 0, -1}), 1e-15);
  EXPECT_NEAR(std::atan2(seen->direction(100, 0).y, -seen->direction(100, 0).z) / kDegree, 15, 1e-12);
}

// A car-like box: at distance 1 it is inside from everywhere, and from the side it nearly fills the picture.
TEST(Camera, OrbitFitsFromEveryAzimuthAtOneDistance) {
  mesh::Mesh mesh;
  for (int corner = 0; corner < 8; ++corner) {
    mesh.positions.push_back(
        {(corner & 1) != 0 ? 2.0 : -2.0, (corner & 2) != 0 ? 1.4 : 0.0, (corner & 4) != 0 ? 0.8 : -0.8});
  }
  double widest = 0;
  for (const double elevation : {-60.0, 0.0, 12.0, 45.0, 89.0, 90.0}) {
    double distance = 0;
    for (int azimuth = 0; azimuth < 360; azimuth += 5) {
      const Camera camera = Camera::orbit(mesh, azimuth, elevation, 1, 30, 16.0 / 9);
      if (azimuth == 0) distance = length(camera.eye - camera.target);
      EXPECT_NEAR(length(camera.eye - camera.target), distance, 1e-9) << "must not breathe";
      const auto seen = rays(camera, 160, 90);
      ASSERT_TRUE(seen.ok());
      const Vec3 ahead = normalized(cross(seen->right, seen->down));
      for (const Vec3& p : mesh.positions) {
        const Vec3 to = p - camera.eye, at = (dot(seen->corner, ahead) / dot(to, ahead)) * to - seen->corner;
        const double x = 2 * dot(at, seen->right) / (dot(seen->right, seen->right) * 160) - 1;
        const double y = 2 * dot(at, seen->down) / (dot(seen->down, seen->down) * 90) - 1;
        EXPECT_LE(std::max(std::abs(x), std::abs(y)), 1) << elevation << " " << azimuth;
        widest = std::max({widest, std::abs(x), std::abs(y)});
      }
    }
  }
  EXPECT_GT(widest, 0.9);
}

TEST(Camera, SilliesAreRefused) {
  Camera camera;
  camera.eye = camera.target;
  EXPECT_EQ(rays(camera, 10, 10).error().message, "the camera's eye and target are the same point");
  camera = {};
  camera.fov_deg = 180;
  EXPECT_FALSE(rays(camera, 10, 10).ok());
  camera = {};
  camera.up = {0, 0, 2};  // along the line of sight
  const auto seen = rays(camera, 10, 10);
  ASSERT_TRUE(seen.ok());
  EXPECT_TRUE(std::isfinite(seen->corner.x + seen->right.y + seen->down.z));
}

}  // namespace
}  // namespace goniochrome::render::camera_test
