// The light of the ground that a page keeps.
#include "render/page_ground.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/angles.h"
#include "render/path/scenes_for_paths_for_test.h"

namespace goniochrome::render::page_ground_test {
namespace {

// A slab above the ground, longer than wide, off the middle of the world.
mesh::Mesh slab() {
  mesh::Mesh box = box_mesh(true);
  for (auto& t : box.triangles) std::swap(t[1], t[2]);  // facing outward
  for (Vec3& n : box.normals) n = -n;
  for (Vec3& p : box.positions) p = {2 + p.x, 0.3 + 0.2 * (p.y + 1), 2 * p.z};
  return box;
}

struct Texel {
  int left = 0, sent = 0;
};
// At a place from the middle of the mesh.
Texel at(const PageGroundLight& light, int turn, double x, double z) {
  const auto line = [&](double place) {
    const double p = place / light.reach, part = 0.5 + 0.5 * p / std::sqrt(1 + p * p);
    return static_cast<std::size_t>(part * light.size);
  };
  const auto size = static_cast<std::size_t>(light.size);
  const std::size_t first = 4 * ((static_cast<std::size_t>(turn) * size + line(z)) * size + line(x));
  const auto byte = [&](std::size_t channel) { return 255 * light.texels[first + channel] / kGroundSteps; };
  return {byte(1), byte(3)};
}

// A sun at 45 degrees above +X throws the shadow toward -X, and lights the side at +X, which lights the ground there.
// The environment turned by 90 degrees brings the sun to where turned directions say; far away nothing is changed. The
// control is the side at -X, which nobody paints: it sends no light.
TEST(PageGround, HasTheShadowAndTheLightOfTheMeshForEachTurn) {
  const envmap::Environment sky = environment_of(64, 32, [](int, int) { return color::Rgb{}; });
  const Vec3 sun = normalized({1, 1, 0});
  const envmap::Environment sunny = environment_of(64, 32, [&](int x, int y) {
    const double light = dot(sky.direction(x, y), sun) > 0.99 ? 60 : 0.5;
    return color::Rgb{light, light, light};
  });
  mesh::Mesh mesh = slab();
  for (mesh::MeshPart& part : mesh.parts)
    if (part.name == "left") part.name = "tire";
  const auto light = page_ground_light(mesh, sunny);
  ASSERT_TRUE(light.ok()) << light.error().message;
  ASSERT_EQ(light->size, 512);
  ASSERT_EQ(light->texels.size(), 4UL * light->size * light->size * light->turns);
  // Turn 2 of 8: a direction d of the environment comes from (d.z, d.y, -d.x).
  for (const auto& [turn, x, z] : {std::tuple(0, 1.0, 0.0), {2, 0.0, -1.0}, {4, -1.0, 0.0}, {6, 0.0, 1.0}}) {
    const double side = x != 0 ? 1 : 2;  // of the slab there
    const Texel shadow = at(*light, turn, -x * (side + 0.2), -z * (side + 0.2)),
                lit = at(*light, turn, x * (side + 0.2), z * (side + 0.2)), below = at(*light, turn, 0, 0),
                far = at(*light, turn, 40 * x, 40 * z);
    EXPECT_LT(shadow.left, 100) << turn;
    EXPECT_GT(lit.left, 200) << turn;
    if (turn == 4)
      EXPECT_EQ(lit.sent, 0);
    else
      EXPECT_GT(lit.sent, shadow.sent + 10) << turn;
    EXPECT_LT(below.left, 40) << turn;
    EXPECT_EQ(far.left, 255) << turn;
    EXPECT_EQ(far.sent, 0) << turn;
  }
}

// Even light throws no sharp shadow, but where a mesh stands on its ground: this one has a foot.
TEST(PageGround, TakesFewerTexelsWhereShadowsAreSoft) {
  const envmap::Environment even = environment_of(64, 32, [](int, int) { return color::Rgb{1, 1, 1}; });
  mesh::Mesh mesh = slab();
  const double low = mesh::bounding_box(mesh).low.y;
  for (Vec3& p : mesh.positions)
    if (p.y == low) p = {0.05 * p.x, p.y, 0.05 * p.z};
  const auto light = page_ground_light(mesh, even);
  ASSERT_TRUE(light.ok()) << light.error().message;
  EXPECT_EQ(light->size, 256);
  EXPECT_EQ(light->texels.size(), 4UL * 256 * 256 * light->turns);
  EXPECT_LT(at(*light, 0, 0, 0).left, 20);
  EXPECT_EQ(at(*light, 0, 40, 0).left, 255);
}

}  // namespace
}  // namespace goniochrome::render::page_ground_test
