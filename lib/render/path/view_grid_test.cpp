#include "render/path/view_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <set>

#include "base/angles.h"
#include "base/parallel.h"
#include "base/random_for_test.h"

namespace goniochrome::render::view_grid_test {
namespace {

// A normal and a viewer on one side, evenly drawn.
ViewGrid::Facing drawn(std::mt19937_64& random) {
  std::uniform_real_distribution<double> in(-1, 1);
  const auto direction = [&] {
    for (;;) {
      const Vec3 v{in(random), in(random), in(random)};
      if (dot(v, v) <= 1 && dot(v, v) > 1e-3) return normalized(v);
    }
  };
  const Vec3 normal = direction(), to_viewer = direction();
  return {dot(normal, to_viewer) < 0 ? -normal : normal, to_viewer};
}

// A function as smooth as the light of a lobe of exponent 4.
double smooth(const ViewGrid::Facing& at) {
  const Vec3 mirrored = 2 * dot(at.normal, at.to_viewer) * at.normal - at.to_viewer;
  return std::exp(2 * dot(mirrored, normalized({1, 2, -1}))) + dot(at.normal, {0.3, 1, 0.2});
}

// The largest error between the nodes, where the viewer is not at a right angle to the normal.
double largest_error(const ViewGrid& grid) {
  std::mt19937_64 random(7);
  double largest = 0;
  for (int i = 0; i < 4000; ++i) {
    const ViewGrid::Facing at = drawn(random);
    const ViewGrid::Place place = grid.place(at.normal, at.to_viewer);
    const auto corners = grid.corners(place.node);
    const auto weights = ViewGrid::weights(place);
    EXPECT_NEAR(std::accumulate(weights.begin(), weights.end(), 0.0), 1, 1e-6);
    double told = 0;
    for (std::size_t c = 0; c < corners.size(); ++c) told += weights[c] * smooth(grid.facing(corners[c]));
    largest = std::max(largest, std::abs(told - smooth(at)));
  }
  return largest;
}

TEST(ViewGrid, FindsItsNodes) {
  const ViewGrid grid(3, 4);
  int found = 0;
  for (std::uint32_t view = 0; view < grid.view_count(); ++view)
    for (std::uint32_t normal = 0; normal < grid.normal_count(); ++normal) {
      const ViewGrid::Facing at = grid.facing({view, normal});
      EXPECT_NEAR(dot(at.normal, at.normal), 1, 1e-12);
      EXPECT_NEAR(dot(at.to_viewer, at.to_viewer), 1, 1e-12);
      EXPECT_GT(dot(at.normal, at.to_viewer), 0);
      // On an edge of the cube the viewer may be found on the other face.
      const ViewGrid::Place place = grid.place(at.normal, at.to_viewer);
      const auto corners = grid.corners(place.node);
      const auto weights = ViewGrid::weights(place);
      const std::size_t nearest = static_cast<std::size_t>(std::ranges::max_element(weights) - weights.begin());
      const ViewGrid::Facing there = grid.facing(corners[nearest]);
      EXPECT_NEAR(length(there.to_viewer - at.to_viewer), 0, 1e-6);
      found += corners[nearest] == ViewGrid::Node{view, normal} ? 1 : 0;
    }
  // All but those that lie on a second face or beyond the horizon, where corners of the square are one normal.
  EXPECT_GE(found, static_cast<int>(grid.view_count() * grid.normal_count() / 2));
}

// Between nodes, lines err by an eighth of the second derivative times the square of the spacing: four times less with
// twice as many cells, in the limit. The exponential bends by at most 15, and the mirror direction turns twice as far
// as the normal: with 24 cells, of up to .15, normals err by .17 along each axis, and views of up to .17 by .05. The
// control: cells that are too few tell hardly anything.
TEST(ViewGrid, ErrsByTheSquareOfItsSpacing) {
  const double coarse = largest_error({6, 12}), fine = largest_error({12, 24});
  EXPECT_LT(fine, coarse / 2.5);
  EXPECT_LT(fine, 2 * (0.17 + 0.05));
  EXPECT_GT(largest_error({1, 2}), 1);
}

TEST(NodeValues, AreFoundOnceAndLinearBetweenNodes) {
  const ViewGrid grid(3, 4);
  const NodeValues values(grid, 2);
  const auto find = [&](const ViewGrid::Node& node, float* numbers) {
    numbers[0] = static_cast<float>(smooth(grid.facing(node))), numbers[1] = 1;
  };
  std::mt19937_64 random(3);
  std::vector<ViewGrid::Place> places;
  std::set<ViewGrid::Node> nodes;
  for (int i = 0; i < 500; ++i) {
    const ViewGrid::Facing at = drawn(random);
    places.push_back(grid.place(at.normal, at.to_viewer));
    for (const ViewGrid::Node& corner : grid.corners(places.back().node)) nodes.insert(corner);
  }
  set_threads(7);
  parallel_each(places.size(), 1, [&](std::size_t i) {
    float sum[2] = {}, direct = 0;
    values.add(places[i], find, sum);
    const auto corners = grid.corners(places[i].node);
    const auto weights = ViewGrid::weights(places[i]);
    for (std::size_t c = 0; c < corners.size(); ++c)
      direct += weights[c] * static_cast<float>(smooth(grid.facing(corners[c])));
    EXPECT_EQ(sum[0], direct);
    EXPECT_NEAR(sum[1], 1, 1e-6);
  });
  set_threads(0);
  EXPECT_EQ(values.found(), nodes.size());
}

}  // namespace
}  // namespace goniochrome::render::view_grid_test
