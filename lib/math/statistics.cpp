#include "math/statistics.h"

#include <cmath>
#include <cstdint>
#include <limits>

namespace goniochrome::math {

namespace {

// The probabilities that k of `drawn` elements are among the `marked` ones of a population, for k from `first` on: the
// hypergeometric distribution. The ratio of neighbors leads from its mode to both sides.
struct Marked {
  std::size_t first;
  std::vector<double> probabilities;

  Marked(std::size_t population, std::size_t marked, std::size_t drawn)
      : first(drawn > population - marked ? drawn - (population - marked) : 0),
        probabilities(std::min(marked, drawn) - first + 1) {
    const auto n = static_cast<double>(population), m = static_cast<double>(marked), d = static_cast<double>(drawn);
    const auto ratio = [&](std::size_t i) {  // of the probability of k + 1 to that of k
      const auto k = static_cast<double>(first + i);
      return (m - k) * (d - k) / ((k + 1) * (n - m - d + k + 1));
    };
    const auto at = static_cast<std::size_t>(std::max(0.0, (d + 1) * (m + 1) / (n + 2) - static_cast<double>(first)));
    const std::size_t mode = std::min(at, probabilities.size() - 1);
    probabilities[mode] = 1;
    for (std::size_t i = mode; i + 1 < probabilities.size(); ++i) probabilities[i + 1] = probabilities[i] * ratio(i);
    for (std::size_t i = mode; i > 0; --i) probabilities[i - 1] = probabilities[i] / ratio(i - 1);
    const double sum = std::accumulate(probabilities.begin(), probabilities.end(), 0.0);
    for (double& probability : probabilities) probability /= sum;
  }
};

}  // namespace

// With q the percentile of the population and X the number of drawn values that do not exceed it, the value of rank l
// in the sample exceeds q where X < l; with Y the number of those below q, the value of rank u is below q where Y >= u.
Range percentile_95_range(std::vector<double> values, std::size_t population) {
  constexpr double kBeyond = 0.158655254;  // of a normal distribution, beyond one standard deviation on one side
  std::sort(values.begin(), values.end());
  const std::size_t rank = (population * 95 + 99) / 100;
  const Marked up_to(population, rank, values.size()), below(population, rank - 1, values.size());
  Range range{values.front(), std::numeric_limits<double>::infinity()};
  double less = 0;
  for (std::size_t i = 0; i < up_to.probabilities.size() && less <= kBeyond; less += up_to.probabilities[i++])
    if (const std::size_t l = up_to.first + i; l > 0) range.low = values[l - 1];
  double more = 0;
  for (std::size_t i = below.probabilities.size(), u = below.first + i; i-- > 0; --u) {
    if (u <= values.size() && more <= kBeyond) range.high = values[u - 1];
    more += below.probabilities[i];
  }
  return range;
}

}  // namespace goniochrome::math
