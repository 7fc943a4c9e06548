// For tests: random numbers that are the same on every machine.
#pragma once

#include <cstdint>

namespace goniochrome {

// Evenly distributed numbers in [0,1), the same on every machine.
class TestNumbers {
 public:
  explicit TestNumbers(std::uint64_t seed) : state_(seed) {}
  double operator()() {
    state_ = state_ * 6364136223846793005U + 1442695040888963407U;
    return static_cast<double>(state_ >> 11) * 0x1p-53;
  }

 private:
  std::uint64_t state_;
};

}  // namespace goniochrome
