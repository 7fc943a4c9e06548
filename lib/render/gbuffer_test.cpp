#include "render/gbuffer.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "render/renderer.h"
#include "render/scenes_for_test.h"

namespace goniochrome::render::gbuffer_test {
namespace {

View slanted_view(const mesh::Mesh& mesh, int samples = 1) {
  return {Camera::orbit(mesh, 33, 21, 1, 30, 1.5), 96, 64, samples, false};
}

// Pictures far from the origin are those at the origin, but for pixels whose center lies on an edge. As floats in the
// world, corners of a sphere of radius 1 lay on a grid of .5 here.
TEST(Gbuffer, IsTheSameFarFromTheOrigin) {
  const mesh::Mesh mesh = sphere_mesh(24);
  mesh::Mesh moved = mesh;
  for (Vec3& p : moved.positions) p += Vec3{5e5, 0, 5.4e6};
  auto renderer = Renderer::create();
  ASSERT_TRUE(renderer.ok());
  const auto near = renderer->look(mesh, slanted_view(mesh));
  ASSERT_TRUE(near.ok());
  const Gbuffer at_origin = **near;
  const auto far = renderer->look(moved, slanted_view(moved));
  ASSERT_TRUE(far.ok());
  int seen = 0, differing = 0;
  for (std::size_t i = 0; i < at_origin.triangles.size(); ++i) {
    seen += at_origin.triangles[i] != kNoTriangle;
    differing += at_origin.triangles[i] != (*far)->triangles[i];
  }
  EXPECT_GT(seen, 1000);
  EXPECT_LE(differing, seen / 100);
}

// The numbers count through all parts, and what shows no triangle shows no part.
TEST(Gbuffer, TrianglesBelongToThePartThatIsSeen) {
  const mesh::Mesh mesh = panels_mesh(3);
  auto renderer = Renderer::create();
  ASSERT_TRUE(renderer.ok());
  const auto drawn = renderer->look(mesh, slanted_view(mesh));
  ASSERT_TRUE(drawn.ok());
  const Gbuffer& g = **drawn;
  int seen = 0;
  for (int y = 0; y < g.height; ++y) {
    for (int x = 0; x < g.width; ++x) {
      const std::uint32_t triangle = g.triangles[g.index(x, y)];
      EXPECT_EQ(triangle == kNoTriangle, g.part(x, y) < 0) << x << ',' << y;
      if (triangle == kNoTriangle) continue;
      EXPECT_EQ(static_cast<int>(triangle / 2), g.part(x, y)) << x << ',' << y;
      ++seen;
    }
  }
  EXPECT_GT(seen, 1000);
}

// The point lies on the ray and on the plane of its triangle, its shares make it from the corners, and on a sphere it
// is where the normal points. The chord of a triangle is h^2/8 = 5e-4 below the sphere, h = pi/50.
TEST(MeshPoint, IsWhereTheRayMeetsTheTriangle) {
  const mesh::Mesh mesh = sphere_mesh(50);
  auto renderer = Renderer::create();
  ASSERT_TRUE(renderer.ok());
  const auto drawn = renderer->look(mesh, slanted_view(mesh));
  ASSERT_TRUE(drawn.ok());
  const Gbuffer& g = **drawn;
  int inside = 0;
  for (int y = 0; y < g.height; ++y) {
    for (int x = 0; x < g.width; ++x) {
      if (g.part(x, y) < 0) continue;
      const MeshPoint point = mesh_point(mesh, g, x, y);
      Vec3 made;
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_GE(point.shares[k], 0);
        made += point.shares[k] * mesh.positions[mesh.triangles[point.triangle][k]];
      }
      EXPECT_LT(length(made - point.position), 1e-14);
      EXPECT_NEAR(length(point.position), 1, 1.1e-3) << "two edges' chords";
      EXPECT_GT(dot(point.face, point.position), 0.99);
      const Vec3 along = point.position - g.rays.eye, ray = -g.to_viewer(x, y);
      if (*std::ranges::min_element(point.shares) == 0) continue;  // moved to the edge
      EXPECT_LT(length(cross(along, ray)), 1e-13);
      ++inside;
    }
  }
  EXPECT_GT(inside, 1200);
}

TEST(MeshPoint, StaysOnTheTriangleThatTheRayMissesOrRunsAlong) {
  const mesh::Mesh mesh = panels_mesh(1);
  const MeshPoint beside = mesh_point(mesh, 0, {2, -0.25, 1}, {0, 0, -1});
  EXPECT_EQ(beside.shares[0], 0);
  EXPECT_NEAR(beside.shares[1] + beside.shares[2], 1, 1e-15);
  EXPECT_EQ(beside.position.z, 0);
  const MeshPoint along = mesh_point(mesh, 0, {2, 0, 0}, {-1, 0, 0});
  for (const double share : along.shares) EXPECT_NEAR(share, 1.0 / 3, 1e-15);
}

}  // namespace
}  // namespace goniochrome::render::gbuffer_test
