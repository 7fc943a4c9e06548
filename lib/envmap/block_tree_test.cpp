#include "envmap/block_tree.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <random>
#include <utility>

#include "base/angles.h"
#include "envmap/patch.h"

namespace goniochrome::envmap::block_tree_test {
namespace {

image::Image noise(int width, int height) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(0, 1);
  image::Image image = {width, height, 3, std::vector<float>(static_cast<std::size_t>(width) * height * 3), {}};
  for (float& value : image.data) value = unit(random);
  return image;
}

constexpr auto kRefused = Environment::BadPixels::kError;

std::vector<Environment> every_layout() {
  CubeMap cube(7);
  cube.texels = noise(7, 42).data;
  return {Environment::from_lat_long(noise(21, 10), kRefused, "lat-long").value(), Environment::from_cube(cube, "cube"),
          Environment::from_cube_edges(noise(6, 36), kRefused, "edges").value(),
          Environment::from_angular(noise(13, 13), kRefused, "probe").value()};
}

// Lambert's closed form: half the sum, over the sides of a spherical polygon, of a side's angle times the unit normal of
// its plane.
Vec3 moment_by_lambert(const std::array<Vec3, 4>& corners) {
  Vec3 sum, middle;
  for (int i = 0; i < 4; ++i) {
    const Vec3 &a = corners[i], &b = corners[(i + 1) % 4], normal = cross(a, b);
    middle += a;
    sum += 0.5 * std::atan2(length(normal), dot(a, b)) * normalized(normal);
  }
  return dot(sum, middle) < 0 ? -1.0 * sum : sum;
}

TEST(BlockTree, TheMomentOfARectangleOnAFaceIsLamberts) {
  const auto at = [](double s, double t) { return normalized(Vec3{s, t, 1}); };
  EXPECT_NEAR(moment_on_face(-1, 1, -1, 1).z, std::sqrt(2.0) * std::acos(1.0 / 3), 1e-5) << "a whole face";
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const double side : {2.0, 0.5, 0.1, 0.01})
    for (int i = 0; i < 200; ++i) {
      const double s0 = unit(random), t0 = unit(random), s1 = std::min(1.0, s0 + side), t1 = std::min(1.0, t0 + side);
      const Vec3 exact = moment_by_lambert({at(s0, t0), at(s1, t0), at(s1, t1), at(s0, t1)});
      EXPECT_LT(length(moment_on_face(s0, s1, t0, t1) - exact), 1e-5 * length(exact) + 1e-12) << side;
    }
}

TEST(BlockTree, TheMomentOfALatLongTexelIsItsIntegral) {
  const Environment env = Environment::from_lat_long(noise(21, 10), kRefused, "lat-long").value();
  for (int row = 0; row < 10; ++row)
    for (int column = 0; column < 21; ++column) {
      const double above = kPi * row / 10, below = kPi * (row + 1) / 10;
      const double high = 2 * kPi * (0.5 - column / 21.0), low = 2 * kPi * (0.5 - (column + 1) / 21.0);
      const double ring = (below - above) / 2 - (std::sin(2 * below) - std::sin(2 * above)) / 4;
      const double sines = std::sin(below) * std::sin(below) - std::sin(above) * std::sin(above);
      const Vec3 exact = {ring * (std::cos(low) - std::cos(high)), 0.5 * sines * (high - low),
                          ring * (std::sin(high) - std::sin(low))};
      const Vec3 moment = moment_of_cell(env, {1.0 * column, 1.0 * row, column + 1.0, row + 1.0});
      EXPECT_LT(length(moment - exact), 1e-5 * length(exact)) << row << " " << column;
    }
}

TEST(BlockTree, SolidAnglesAreThoseOfTheGrid) {
  for (const Environment& env : every_layout()) {
    const SolidAngles angles(env.grid());
    double sum = 0;
    for (int row = 0; row < env.height(); ++row)
      for (int column = 0; column < env.width(); ++column) {
        EXPECT_NEAR(angles.at(column, row), env.grid().solid_angle(column, row), 1e-14) << int(env.layout());
        sum += angles.at(column, row);
      }
    EXPECT_NEAR(sum / (4 * kPi), 1, env.layout() == Environment::Layout::kAngular ? 1e-3 : 1e-12) << int(env.layout());
  }
}

// A walk meets a block before its texels, which follow each other.
TEST(BlockTree, EveryBlockHoldsItsTexelsInItsCap) {
  for (const Environment& env : every_layout()) {
    const BlockTree tree(env);
    std::vector<std::pair<BlockTree::Block, std::size_t>> blocks;  // and the first of its texels
    std::vector<int> texels;
    tree.walk(
        [&](const BlockTree::Block& block) {
          blocks.emplace_back(block, texels.size());
          return true;
        },
        [&](int column, int row) { texels.push_back(row * env.width() + column); });
    ASSERT_EQ(texels.size(), static_cast<std::size_t>(env.width()) * env.height());

    std::map<int, std::vector<Vec3>> directions;
    std::mt19937 random(9);
    std::normal_distribution<double> normal;
    for (int i = 0; i < 20000; ++i) {
      const Vec3 d = normalized({normal(random), normal(random), normal(random)});
      directions[env.grid().texel(d)].push_back(d);
    }
    for (const auto& [block, first] : blocks) {
      const Vec3 axis = {block.axis[0], block.axis[1], block.axis[2]};
      double area = 0, flux = 0;
      for (std::size_t i = first; area < block.area * (1 - 1e-5); ++i) {
        ASSERT_LT(i, texels.size());
        const int column = texels[i] % env.width(), row = texels[i] / env.width();
        area += env.grid().solid_angle(column, row);
        flux += env.grid().solid_angle(column, row) * env.radiance(column, row)[1];
        for (const Vec3& d : directions[texels[i]]) EXPECT_GE(dot(axis, d), block.cosine - 1e-7) << int(env.layout());
      }
      EXPECT_NEAR(area, block.area, 1e-5 * area);
      EXPECT_NEAR(flux, block.flux[1], 1e-5 * flux);
    }
  }
}

}  // namespace
}  // namespace goniochrome::envmap::block_tree_test
