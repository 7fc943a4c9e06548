// Control charts of individuals and moving ranges, as in Shewhart's practice [ISO 7870-2].
#pragma once

#include <cstddef>
#include <vector>

namespace goniochrome::quality {

// The standard deviation of the process comes from the mean range of neighbors, which a slow drift hardly widens: mean
// range / d2, d2 = 1.128 for two values. The upper limit of the ranges is D4 = 3.267 times their mean.
struct ControlChart {
  double mean = 0, sigma = 0, mean_range = 0, range_limit = 0;
  std::vector<double> ranges;       // of each value and the one before; one fewer than the values
  std::vector<std::size_t> beyond;  // values that lie more than three sigma from the mean
};

// `values` has one or more, in the order of time.
ControlChart control_chart(const std::vector<double>& values);

}  // namespace goniochrome::quality
