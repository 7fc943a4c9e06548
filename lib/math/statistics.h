// Means, medians and percentiles summarize samples. None of them takes an empty list.
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <span>
#include <vector>

namespace goniochrome::math {

inline double mean(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// The value that `rank` others precede in ascending order, 0 <= rank < values.size().
template <class Number>
Number ranked(std::vector<Number> values, std::size_t rank) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// The middle value; of an even number of values, the larger one of the two in the middle.
template <class Number>
Number median(std::vector<Number> values) {
  const std::size_t middle = values.size() / 2;
  return ranked(std::move(values), middle);
}

// The least value that at least 95 of 100 values do not exceed.
inline double percentile_95(std::vector<double> values) {
  const std::size_t rank = (values.size() * 95 + 99) / 100 - 1;
  return ranked(std::move(values), rank);
}

struct Range {
  double low, high;
};

// The range of one standard error of percentile_95() of a population, from values that were drawn from it without
// return, by their ranks: either end is passed with a probability of .159 at most. The upper end is infinite where the
// values are too few, as below 36 of a large population.
Range percentile_95_range(std::vector<double> values, std::size_t population);

}  // namespace goniochrome::math
