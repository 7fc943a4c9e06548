#include "render/path/visible_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "render/camera.h"
#include "render/scenes_for_test.h"

namespace goniochrome::render::visible_surface_test {
namespace {

constexpr int kSize = 192;

// A sphere, and before it an upright bar of so many pixels whose foot is this far beside its head.
mesh::Mesh sphere_and_bar(double pixels, double lean_pixels) {
  mesh::Mesh mesh = sphere_mesh(64);
  const double pixel = 2 * 1.2 / kSize, half = 0.5 * pixels * pixel, lean = 0.5 * lean_pixels * pixel, x = 0.103;
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const Vec3& corner :
       {Vec3{x - lean - half, -1, 1}, {x - lean + half, -1, 1}, {x + lean + half, 1, 1}, {x + lean - half, 1, 1}})
    mesh.positions.push_back(corner), mesh.normals.push_back({0, 0, 1});
  mesh.parts.push_back({"bar", "", mesh.triangles.size(), 2});
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
  return mesh;
}

// From far away, so that a length is as many pixels everywhere.
Rays far_view() {
  Camera camera;
  camera.eye = {0, 0, 100};
  camera.fov_deg = 2 * std::atan(1.2 / 99) / kDegree;
  return *rays(camera, kSize, kSize);
}

struct Case {
  SampledSurface found;
  std::vector<Gbuffer> traced;  // all by rays
};
Case looked_at(const mesh::Mesh& mesh, int samples) {
  const rays::RayScene scene = *rays::RayScene::create(mesh);
  const Rays view = far_view();
  const auto shifts = sample_shifts(samples);
  Case all{sampled_surface(scene, mesh_gbuffer(scene, view, kSize, kSize), shifts), {}};
  for (const auto& [x, y] : shifts) all.traced.push_back(mesh_gbuffer(scene, view.shifted(x, y), kSize, kSize));
  return all;
}

// At edges every ray is traced; amid a piece the triangles of the centers stand for those of the samples, and normals
// are turned to where the samples lie. The control: normals of the centers are ten times as far off.
TEST(SampledSurface, IsThatOfRaysAtEdgesAndNearItElsewhere) {
  for (const int samples : {4, 16}) {
    const Case all = looked_at(sphere_and_bar(6, 2), samples);
    const Rays view = far_view();
    double turned = 0, of_centers = 0;
    std::size_t amid = 0;
    const rays::RayScene scene = *rays::RayScene::create(sphere_and_bar(6, 2));
    const Gbuffer centers = mesh_gbuffer(scene, view, kSize, kSize);
    for (std::size_t k = 0; k < all.traced.size(); ++k) {
      const Gbuffer &found = all.found.samples[k], &traced = all.traced[k];
      for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
          const std::size_t at = traced.index(x, y);
          EXPECT_EQ(found.part(x, y), traced.part(x, y)) << x << "," << y;
          if (all.found.edges[at] != 0) {
            EXPECT_EQ(found.triangles[at], traced.triangles[at]) << x << "," << y;
            EXPECT_TRUE(std::equal(found.at(x, y), found.at(x, y) + 4, traced.at(x, y))) << x << "," << y;
          } else if (traced.part(x, y) == 0) {
            turned = std::max(turned, length(found.normal(x, y) - traced.normal(x, y)));
            of_centers = std::max(of_centers, length(centers.normal(x, y) - traced.normal(x, y)));
            ++amid;
          }
        }
      }
    }
    EXPECT_GT(amid, 1000U * static_cast<std::size_t>(samples));
    EXPECT_LT(turned, 2e-3);
    EXPECT_GT(of_centers, 10 * turned);
  }
}

// A bar narrower than a pixel that leans a little passes between the centers of pixels for long stretches: where its
// edges are found in one pixel, they are followed to the next. The control: pixels about which the centers show several
// pieces are no more than half of those that the bar crosses.
TEST(SampledSurface, FollowsAThinBarBetweenTheCenters) {
  const mesh::Mesh mesh = sphere_and_bar(0.4, 3);
  const rays::RayScene scene = *rays::RayScene::create(mesh);
  const Gbuffer centers = mesh_gbuffer(scene, far_view(), kSize, kSize);
  const Case all = looked_at(mesh, 4);
  int crossed = 0, by_centers = 0;
  for (int y = 2; y < kSize - 2; ++y) {
    for (int x = 2; x < kSize - 2; ++x) {
      if (std::ranges::none_of(all.traced, [&](const Gbuffer& g) { return g.part(x, y) == 1; })) continue;
      ++crossed;
      EXPECT_NE(all.found.edges[centers.index(x, y)], 0) << x << "," << y;
      for (std::size_t k = 0; k < all.traced.size(); ++k)
        EXPECT_EQ(all.found.samples[k].part(x, y), all.traced[k].part(x, y)) << x << "," << y;
      bool seen = false;
      for (int v = y - 1; v <= y + 1; ++v)
        for (int u = x - 1; u <= x + 1; ++u) seen = seen || centers.part(u, v) != centers.part(x, y);
      by_centers += seen ? 1 : 0;
    }
  }
  EXPECT_GT(crossed, 150);
  EXPECT_LT(by_centers, 0.6 * crossed);
}

}  // namespace
}  // namespace goniochrome::render::visible_surface_test
