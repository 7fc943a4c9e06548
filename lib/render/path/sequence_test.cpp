// The sequence against what its construction promises: nets, uniformity, sets that know nothing of each other.
#include "render/path/sequence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

namespace goniochrome::render::sequence_test {
namespace {

// Every elementary box of area 2^-k holds one of the first 2^k points in the first two dimensions.
TEST(Sequence, FillsEveryElementaryBoxOnce) {
  for (const std::uint64_t seed : {1ULL, 77ULL, 0xDEADBEEFULL}) {
    for (const std::uint32_t set : {0U, 5U}) {
      const Sequence sequence(seed);
      for (int k = 1; k <= 10; ++k) {
        for (int across = 0; across <= k; ++across) {
          std::set<std::pair<int, int>> boxes;
          for (std::uint32_t i = 0; i < 1U << k; ++i) {
            const auto p = sequence.point(i, set);
            boxes.insert({static_cast<int>(std::ldexp(p[0], across)), static_cast<int>(std::ldexp(p[1], k - across))});
          }
          EXPECT_EQ(boxes.size(), std::size_t{1} << k) << k << " " << across;
        }
      }
    }
  }
}

TEST(Sequence, EveryDimensionOfABatchIsStratified) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const Sequence sequence(seed);
    for (std::size_t d = 0; d < 4; ++d) {
      std::set<int> strata;
      for (std::uint32_t i = 0; i < 16; ++i) strata.insert(static_cast<int>(16 * sequence.point(i, 3)[d]));
      EXPECT_EQ(strata.size(), 16U);
    }
  }
}

// One point each of many seeds: pairs of dimensions fill 16 x 16 cells evenly. Chi-square of 255 degrees of freedom has
// mean 255 and standard deviation sqrt(510) = 22.6; six of them are 136. The control correlates the two numbers.
TEST(Sequence, SeedsAndSetsAreIndependent) {
  constexpr int kCount = 1 << 18;
  const auto chi_square = [&](const auto& pair) {
    std::vector<int> cells(256);
    for (int i = 0; i < kCount; ++i) {
      const auto [a, b] = pair(static_cast<std::uint64_t>(i));
      ++cells[static_cast<std::size_t>(16 * a) * 16 + static_cast<std::size_t>(16 * b)];
    }
    double sum = 0;
    for (const int n : cells) sum += (n - kCount / 256.0) * (n - kCount / 256.0) / (kCount / 256.0);
    return sum;
  };
  constexpr double kMost = 255 + 136;
  using Pair = std::pair<double, double>;
  for (std::size_t a = 0; a < 4; ++a)
    for (std::size_t b = a + 1; b < 4; ++b)
      EXPECT_LT(chi_square([&](std::uint64_t i) {
                  const auto p = Sequence(i).point(0, 0);
                  return Pair{p[a], p[b]};
                }),
                kMost);
  EXPECT_LT(chi_square([](std::uint64_t i) {
              return Pair{Sequence(i).point(3, 0)[0], Sequence(i).point(3, 1)[0]};
            }),
            kMost);
  EXPECT_LT(chi_square([](std::uint64_t i) {
              return Pair{Sequence(i).point(3, 0)[1], Sequence(i + 1).point(3, 0)[1]};
            }),
            kMost);
  // One index in two dimensions, over the index: points of one seed are not independent, but even.
  EXPECT_LT(chi_square([](std::uint64_t i) {
              const auto p = Sequence(i / 1024).point(static_cast<std::uint32_t>(i % 1024), 0);
              return Pair{p[2], p[3]};
            }),
            kMost);
  EXPECT_GT(chi_square([](std::uint64_t i) {
              const auto p = Sequence(i).point(0, 0);
              return Pair{p[0], 0.9 * p[0] + 0.1 * p[1]};
            }),
            kMost);
}

// The error of a smooth integral falls nearly with the number of points; of independent points with its root.
TEST(Sequence, IntegratesBetterThanChance) {
  double squared = 0;
  constexpr int kSeeds = 200, kPoints = 256;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Sequence sequence(seed);
    double sum = 0;
    for (std::uint32_t i = 0; i < kPoints; ++i) {
      const auto p = sequence.point(i, 0);
      sum += p[0] * p[1] + std::sin(3 * p[2]) * p[3];
    }
    const double error = sum / kPoints - (0.25 + 0.5 * (1 - std::cos(3.0)) / 3);
    squared += error * error / kSeeds;
  }
  // Independent points: variance (7/144 + ...) of about 0.16 over 256, that is 0.025 as a root.
  EXPECT_LT(std::sqrt(squared), 0.025 / 5);
}

}  // namespace
}  // namespace goniochrome::render::sequence_test
