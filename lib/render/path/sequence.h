// Low-discrepancy numbers for paths: Sobol's sequence in four dimensions, scrambled as Owen has it, a fresh scramble
// for each further set of four. goniochrome-paths(7), "PATHS"; [Sobol1967], [Owen1995], hashing after [Burley2020].
#pragma once

#include <array>
#include <cstdint>

namespace goniochrome::render {

// A well mixed number of two others.
constexpr std::uint64_t mixed(std::uint64_t a, std::uint64_t b) {
  std::uint64_t z = a + 0x9E3779B97F4A7C15U * (b + 1);
  z = (z ^ (z >> 32)) * 0xD6E8FEB86659FD93U;
  z = (z ^ (z >> 29)) * 0xA0761D6478BD642FU;
  return z ^ (z >> 32);
}

// Points in the unit cube [0,1)^4 for any number of sets. The first 2^k points of a set, for any k, fall one each into
// 2^k equal boxes in every elementary division of the first two dimensions, and nearly so in the others; the sets are
// independent of each other, and so are sequences of different seeds.
class Sequence {
 public:
  // One set, whose scramble is made once for all of its points.
  class Set {
   public:
    std::array<double, 4> point(std::uint32_t index) const;

   private:
    friend class Sequence;
    Set(std::uint64_t seed, std::uint32_t set, std::uint32_t mask);
    std::array<std::uint32_t, 4> seeds_;
    std::uint32_t order_, mask_;
  };

  // `points`: of each set, a power of two; beyond them they come again. The fewer, the faster.
  explicit Sequence(std::uint64_t seed, std::uint32_t points = 1024) : seed_(seed), mask_(points - 1) {}

  std::array<double, 4> point(std::uint32_t index, std::uint32_t set) const { return this->set(set).point(index); }
  Set set(std::uint32_t number) const { return {seed_, number, mask_}; }
  // Another sequence of as many points.
  Sequence other(std::uint64_t number) const { return Sequence(mixed(seed_, number), mask_ + 1); }

 private:
  std::uint64_t seed_;
  std::uint32_t mask_;
};

}  // namespace goniochrome::render
