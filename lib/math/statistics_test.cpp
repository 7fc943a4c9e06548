#include "math/statistics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random_for_test.h"

namespace goniochrome::math::statistics_test {
namespace {

TEST(Percentile95Range, HoldsThePercentileOfThePopulationAsOftenAsItSays) {
  constexpr int kTrials = 4000;
  constexpr std::size_t kPopulation = 3000;
  TestNumbers random(3);
  std::vector<double> population;
  for (std::size_t i = 0; i < kPopulation; ++i) population.push_back(-std::log(1 - random()));
  const double truth = percentile_95(population);
  for (const std::size_t count : {50, 400, 2000}) {
    int below = 0, above = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
      for (std::size_t i = 0; i < count; ++i)
        std::swap(population[i], population[i + static_cast<std::size_t>(random() * double(kPopulation - i))]);
      const Range range =
          percentile_95_range({population.begin(), population.begin() + std::ptrdiff_t(count)}, kPopulation);
      below += truth<range.low, above += truth> range.high;
    }
    // .159 at most on either side, and 4 standard deviations of the trials; ranks are whole, so that few may be less.
    const double most = 0.159 + 4 * std::sqrt(0.159 * 0.841 / kTrials), least = count == 50 ? 0.03 : 0.09;
    EXPECT_LT(below, most * kTrials) << count;
    EXPECT_LT(above, most * kTrials) << count;
    EXPECT_GT(below, least * kTrials) << count;
    EXPECT_GT(above, least * kTrials) << count;
  }
}

TEST(Percentile95Range, OfAWholePopulationIsItsPercentile) {
  std::vector<double> values;
  for (int i = 1; i <= 137; ++i) {
    values.push_back(i);
    const Range range = percentile_95_range(values, values.size());
    EXPECT_EQ(range.low, percentile_95(values));
    EXPECT_EQ(range.high, percentile_95(values));
  }
}

TEST(Percentile95Range, HasNoUpperEndWhereValuesAreTooFew) {
  // .95^35 is above .159, and .95^36 below.
  EXPECT_TRUE(std::isinf(percentile_95_range(std::vector<double>(35, 1.0), 100000000).high));
  EXPECT_EQ(percentile_95_range(std::vector<double>(36, 1.0), 100000000).high, 1);
}

}  // namespace
}  // namespace goniochrome::math::statistics_test
