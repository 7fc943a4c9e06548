// The median of any number of relative errors in constant memory.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace goniochrome::capture {

// Counts errors by their logarithm, so that the median is exact to 1 %. Errors below 1e-6 count as that, and above 1e3
// as that.
class ErrorTally {
 public:
  void add(double error) {
    const double place = std::log(std::clamp(error, kLeast, kMost) / kLeast) / kStep;
    ++counts_[std::min(counts_.size() - 1, static_cast<std::size_t>(place))];
    ++count_;
  }
  void add(const ErrorTally& other) {
    for (std::size_t i = 0; i < counts_.size(); ++i) counts_[i] += other.counts_[i];
    count_ += other.count_;
  }
  // 0 where there is none.
  double median() const {
    if (count_ == 0) return 0;
    std::uint64_t below = 0;
    std::size_t i = 0;
    while (2 * (below + counts_[i]) <= count_ && i + 1 < counts_.size()) below += counts_[i++];
    return kLeast * std::exp((static_cast<double>(i) + 0.5) * kStep);
  }
  std::uint64_t count() const { return count_; }

 private:
  static constexpr double kLeast = 1e-6, kMost = 1e3, kStep = 0.01;
  std::vector<std::uint64_t> counts_ = std::vector<std::uint64_t>(2080);
  std::uint64_t count_ = 0;
};

}  // namespace goniochrome::capture
