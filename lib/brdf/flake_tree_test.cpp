#include "brdf/flake_tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/parallel.h"

namespace goniochrome::brdf::flake_tree_test {
namespace {

constexpr double kDensity = 1.2e9;  // a square meter

// Boxes of one size side by side.
std::vector<double> counts(const FlakeTree& tree, FlakeBox box, int boxes) {
  std::vector<double> counts;
  for (int i = 0; i < boxes; ++i) {
    box.place = {box.size[0] * (i % 100) * 1.01, box.size[1] * (i / 100) * 1.01};
    counts.push_back(tree.count(box));
  }
  return counts;
}

// The probability of each count below the last, and of the last and more, by chi-square against Poisson. Boxes with an
// expectation of less than 8 are joined.
double chi_square(const std::vector<double>& counts, double mean, int& degrees) {
  double chi = 0, expected = 0, seen = 0, probability = std::exp(-mean), left = 1;
  degrees = -1;
  for (int k = 0;; probability *= mean / ++k) {
    expected += probability * static_cast<double>(counts.size());
    left -= probability;
    for (const double count : counts) seen += count == k ? 1 : 0;
    const bool last = left * static_cast<double>(counts.size()) < 8;
    if (last) {
      expected += std::max(0.0, left) * static_cast<double>(counts.size());
      for (const double count : counts) seen += count > k ? 1 : 0;
    }
    if (expected < 8 && !last) continue;
    chi += (seen - expected) * (seen - expected) / expected;
    ++degrees, expected = seen = 0;
    if (last) return chi;
  }
}

TEST(FlakeTree, CountsArePoisson) {
  bool rare = false, many = false;
  for (const double side : {3e-5, 2e-4, 1e-3, 7e-3})
    for (const double part : {1e-5, 1e-3, 0.1}) {
      const FlakeBox box{{}, {side, 1.3 * side}, {0.3, 0.95}, {std::sqrt(part), std::sqrt(part)}, 0.7};
      const double mean = kDensity * box.area() * box.part();
      if (mean > 100) continue;
      rare |= mean < 0.1, many |= mean > 50;
      int degrees = 0;
      const double chi = chi_square(counts(FlakeTree(kDensity, 7), box, 10000), mean, degrees);
      // Four standard deviations of chi-square.
      EXPECT_LT(chi, degrees + 4 * std::sqrt(2.0 * degrees) + 4) << "mean " << mean;
    }
  EXPECT_TRUE(rare && many);
}

// The control: counts of another mean fail.
TEST(FlakeTree, ChiSquareTellsAnotherMean) {
  const FlakeBox box{{}, {1e-3, 1e-3}, {0.3, 0.2}, {0.1, 0.1}, 0.7};
  int degrees = 0;
  const auto seen = counts(FlakeTree(kDensity, 7), box, 10000);
  EXPECT_GT(chi_square(seen, 1.05 * kDensity * box.area() * box.part(), degrees),
            degrees + 4 * std::sqrt(2.0 * degrees) + 4);
}

TEST(FlakeTree, CountsOfMoreThanABillionAreTheirMean) {
  const FlakeTree tree(kDensity, 1);
  const FlakeBox wide{{}, {1.5, 1.5}};
  EXPECT_EQ(tree.count(wide), kDensity * wide.area());
  const FlakeBox less{{0.001, 0.002}, {0.2, 0.2}};
  EXPECT_NEAR(tree.count(less) / (kDensity * less.area()), 1, 1e-3);
}

// A view from near by counts the flakes of a view from afar in many boxes.
TEST(FlakeTree, HoldsTheSameFlakesFromNearAndFar) {
  const FlakeTree tree(kDensity, 3);
  const FlakeBox far{{0.0123, 0.0456}, {5e-4, 5e-4}, {0.4, 0.6}, {0.1, 0.1}};
  const double together = tree.count(far);
  EXPECT_GT(together, 1);
  double apart = 0;
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j) {
      FlakeBox near = far;
      near.size = {far.size[0] / 20, far.size[1] / 20};
      near.place = {far.place[0] + i * near.size[0], far.place[1] + j * near.size[1]};
      apart += tree.count(near);
    }
  EXPECT_NEAR(apart, together, 1);  // but for a flake upon an edge
  EXPECT_NE(FlakeTree(kDensity, 4).count(far), together) << "another seed has other flakes";
}

// The light of all flakes rests on this: mean and variance of the count of some turns are exact.
TEST(FlakeTree, FlakesOfSomeTurnsArePoisson) {
  const FlakeTree tree(kDensity, 2);
  for (const double side : {5e-5, 2e-4, 1e-3})
    for (const double turns : {0.05, 0.444, 0.5}) {
      FlakeBox box{{}, {side, side}, {0, 1.2}, {1, turns}, 0.577};
      const double mean = kDensity * box.area() * box.part();
      double sum = 0, squares = 0;
      constexpr int kBoxes = 20000;
      for (int i = 0; i < kBoxes; ++i) {
        box.place = {side * (i % 141), side * (i / 141)};
        const double change = tree.count(box) / mean - 1;
        sum += change, squares += change * change;
      }
      EXPECT_NEAR(sum / kBoxes, 0, 4 / std::sqrt(mean * kBoxes)) << side << " " << turns;
      EXPECT_NEAR(squares / kBoxes * mean, 1, 0.05) << side << " " << turns;
    }
}

// Flakes flash one after the other while a box moves over tilts: few of them come or go at a step.
TEST(FlakeTree, CountsChangeLittleWhileTiltsMoveLittle) {
  const FlakeTree tree(kDensity, 3);
  FlakeBox box{{0.01, 0.02}, {1e-3, 1e-3}, {0.3, 0.3}, {0.1, 0.1}};
  double changed = 0, before = tree.count(box), sum = 0;
  for (int step = 1; step <= 200; ++step) {
    box.tilt[0] = 0.3 + 5e-4 * step;
    const double now = tree.count(box);
    changed += std::abs(now - before), sum += now, before = now;
  }
  // A step moves 1 part in 100 of the flakes of two sides: of some 12 flakes, about one in four steps.
  EXPECT_LT(changed, 0.05 * sum);
  EXPECT_GT(changed, 10) << "it stands still";
}

TEST(FlakeTree, IsTheSameForAnyNumberOfThreads) {
  const FlakeTree tree(kDensity, 5);
  std::vector<double> found[2];
  for (int threads : {1, 4}) {
    set_threads(threads);
    std::vector<double>& counts = found[threads == 1 ? 0 : 1];
    counts.resize(2000);
    parallel_for(counts.size(), 16, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        counts[i] = tree.count({{1e-3 * static_cast<double>(i), 0.3}, {1e-3, 1e-3}, {0.5, 0.9}, {0.05, 0.3}});
    });
  }
  set_threads(0);
  EXPECT_EQ(found[0], found[1]);
}

}  // namespace
}  // namespace goniochrome::brdf::flake_tree_test
