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

// Window coordinates of the matrix against the ray through them: float rounding of the matrix, 1e-6 of the picture.
TEST(Camera, MatrixAndRaysAgree) {
  TestNumbers random(1);
  for (int trial = 0; trial < 2000; ++trial) {
    const auto point = [&](double size) {
      return Vec3{size * (random() - 0.5), size * (random() - 0.5), size * (random() - 0.5)};
    };
    Camera camera;
    camera.eye = 5 * normalized(point(1)) + point(1);
    camera.target = point(1);
    camera.fov_deg = 5 + 120 * random();
    const int width = 100 + static_cast<int>(2000 * random()), height = 100 + static_cast<int>(2000 * random());
    const auto seen = rays(camera, width, height);
    ASSERT_TRUE(seen.ok());
    const double shift_x = random() - 0.5, shift_y = random() - 0.5;
    const auto m = clip_matrix(camera, *seen, width, height, {{-1, -1, -1}, {1, 1, 1}}, shift_x, shift_y);
    const Vec3 p = point(1);
    const double in[4] = {p.x, p.y, p.z, 1};
    double clip[4] = {0, 0, 0, 0};
    for (int row = 0; row < 4; ++row) {
      for (int column = 0; column < 4; ++column)
        clip[row] += m[static_cast<std::size_t>(4 * column + row)] * in[column];
    }
    ASSERT_GT(clip[3], 0);
    EXPECT_LE(std::abs(clip[2]), clip[3]) << "between near and far";
    const double x = (clip[0] / clip[3] + 1) / 2 * width + shift_x, y = (clip[1] / clip[3] + 1) / 2 * height + shift_y;
    const Vec3 ray = seen->direction(x, y), wanted = normalized(p - camera.eye);
    EXPECT_LT(length(cross(ray, wanted)), 2e-6 * (1 + std::hypot(x / width, y / height)));
  }
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
      const auto m = clip_matrix(camera, *seen, 160, 90, mesh::bounding_box(mesh), 0, 0);
      for (const Vec3& p : mesh.positions) {
        const double w = m[3] * p.x + m[7] * p.y + m[11] * p.z + m[15];
        const double x = (m[0] * p.x + m[4] * p.y + m[8] * p.z + m[12]) / w;
        const double y = (m[1] * p.x + m[5] * p.y + m[9] * p.z + m[13]) / w;
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
