#include "quality/control_chart.h"

#include <cmath>

#include "math/statistics.h"

namespace goniochrome::quality {

ControlChart control_chart(const std::vector<double>& values) {
  constexpr double kD2 = 1.128, kD4 = 3.267;
  ControlChart chart;
  chart.mean = math::mean(values);
  for (std::size_t i = 1; i < values.size(); ++i) chart.ranges.push_back(std::abs(values[i] - values[i - 1]));
  if (!chart.ranges.empty()) chart.mean_range = math::mean(chart.ranges);
  chart.sigma = chart.mean_range / kD2, chart.range_limit = kD4 * chart.mean_range;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (std::abs(values[i] - chart.mean) > 3 * chart.sigma) chart.beyond.push_back(i);
  return chart;
}

}  // namespace goniochrome::quality
