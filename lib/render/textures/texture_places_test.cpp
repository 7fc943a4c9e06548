#include "render/textures/texture_places.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/angles.h"
#include "render/scenes_for_test.h"

namespace goniochrome::render::texture_places_test {
namespace {

TEST(TexturePlaces, OwnCoordinatesAndThoseMadeAroundTheAxis) {
  mesh::Mesh mesh = sphere_mesh(64);
  Camera camera;
  camera.eye = {0, 0, 6};
  const Gbuffer g = seen_by_rays(mesh, camera, 64, 64);
  const auto made = TextureLayout(mesh, {true}).places(g);
  const TexturePlace& middle = made[32 * 64 + 32];  // half a pixel right and down of the middle
  EXPECT_NEAR(middle.u, 0, 0.02);
  EXPECT_NEAR(middle.v, 1 / (2 * kPi), 0.02);
  EXPECT_NEAR(middle.tangent[0], 1, 0.05);
  EXPECT_NEAR(middle.tangent[1], 0, 0.05);
  // Across the sphere u runs through a half turn, its own coordinates likewise.
  EXPECT_NEAR(made[32 * 64 + 40].u, std::asin((8.5 / 32) * std::tan(15 * M_PI / 180) * 5 / 1) / (2 * M_PI), 0.02);
  for (const Vec3& p : mesh.positions)
    mesh.texture.push_back({static_cast<float>(3 * p.x), static_cast<float>(3 * p.y)});
  const auto own = TextureLayout(mesh, {true}).places(g);
  EXPECT_NEAR(own[32 * 64 + 32].u, 0, 0.15);
  EXPECT_NEAR(own[20 * 64 + 40].tangent[0], 1, 0.4);
  EXPECT_GT(own[20 * 64 + 40].u, 0.3);
  EXPECT_GT(own[20 * 64 + 40].v, 0.3);
}

// Only the left panel has a texture: where the other part or nothing is seen, there is no place.
TEST(TexturePlaces, AreThoseOfTexturedPartsAlone) {
  mesh::Mesh mesh = panels_mesh(2);
  mesh.texture.assign(mesh.positions.size(), {0.25F, 0.75F});
  Camera camera;
  camera.eye = {0, 0, 3};
  const Gbuffer g = seen_by_rays(mesh, camera, 32, 32);
  const auto places = TextureLayout(mesh, {true, false}).places(g);
  int parts[3] = {0, 0, 0};
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) {
      ++parts[g.part(x, y) + 1];
      EXPECT_EQ(places[g.index(x, y)].u, g.part(x, y) == 0 ? 0.25F : 0) << x << ',' << y;
    }
  }
  for (const int seen : parts) EXPECT_GT(seen, 50);
}

}  // namespace
}  // namespace goniochrome::render::texture_places_test
