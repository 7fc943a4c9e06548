#include "materials/internal/tensor_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "base/angles.h"
#include "materials/internal/shown.h"

namespace goniochrome::materials::tensor_tree_test {
namespace {

// A color that changes with all that it may change with: the incidence, the exit, and the angle between both.
color::Xyz smooth(const Vec3& light, const Vec3& view) {
  const double about = dot({-light.x, -light.y, light.z}, view),
               Y = 0.05 + 0.03 * light.z + 0.1 * std::pow(std::max(about, 0.0), 6);
  return {Y * (1 - 0.1 * about), Y, Y * (1 + 0.2 * view.z)};
}

double largest_error(const TensorTree& tree, double turn_rad) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(0, 1);
  double worst = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 light = direction(80 * kDegree * share(random), turn_rad),
               view = direction(80 * kDegree * share(random), 2 * kPi * share(random));
    const color::Xyz is = tree.at(light, view), was = smooth(light, view);
    const color::Xyz white{1, 1, 1};
    const auto lab = [&](const color::Xyz& f) { return color::lab_from_xyz({kPi * f.X, kPi * f.Y, kPi * f.Z}, white); };
    worst = std::max(worst, color::delta_e_2000(lab(is), lab(was)));
  }
  return worst;
}

// A leaf has a range of 1/2 in lightness and in both chromaticities, so that no direction is farther from its mean than
// the three together; at the rim of the disc a finest cell has 0.2 more. What is looked up does not depend on where the
// light stands around the normal.
TEST(TensorTree, KeepsTheColorOfEveryDirection) {
  const TensorTree tree(smooth);
  for (const double turn_rad : {0.0, 1.0, 2.5, kPi}) EXPECT_LE(largest_error(tree, turn_rad), 1.2);
}

// Leaves that are merged have the mean of their cells, so that light is neither lost nor made.
TEST(TensorTree, KeepsTheLight) {
  const TensorTree tree(smooth);
  constexpr int kPlaces = 400;
  const Vec3 light = direction(std::asin(1 - 91.0 / 256), kPi);  // 40.1 deg, in the middle of the finest cells
  double is = 0, was = 0;
  for (int i = 0; i < kPlaces; ++i)
    for (int j = 0; j < kPlaces; ++j) {
      const double x = 2 * (i + 0.5) / kPlaces - 1, y = 2 * (j + 0.5) / kPlaces - 1;
      if (x * x + y * y >= 1) continue;
      const Vec3 view{x, y, std::sqrt(1 - x * x - y * y)};
      is += tree.at(light, view).Y, was += smooth(light, view).Y;
    }
  EXPECT_NEAR(is / was, 1, 1.5e-3);
}

TEST(TensorTree, AnEvenColorIsAFewLeaves) {
  const TensorTree tree([](const Vec3&, const Vec3&) { return color::Xyz{0.2, 0.2, 0.2}; });
  const std::string text = tree.text(0);
  // All branch down to the 4 x 8 x 8 cells of depth 3, and below these the ways to the black cell and to its mirror
  // image, which leave seven leaves at each of five depths.
  EXPECT_EQ(std::ranges::count(text, '.'), 256 - 2 + 2 * 5 * 7);
  EXPECT_EQ(std::ranges::count(text, '{'), std::ranges::count(text, '}'));
}

}  // namespace
}  // namespace goniochrome::materials::tensor_tree_test
