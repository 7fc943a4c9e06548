#include "render/path/sequence.h"

#include <bit>

namespace goniochrome::render {

namespace {

constexpr int kBits = 32;
using Columns = std::array<std::uint32_t, kBits>;

constexpr std::uint32_t reversed(std::uint32_t x) {
  x = x << 16 | x >> 16;
  x = (x & 0x00FF00FFU) << 8 | (x & 0xFF00FF00U) >> 8;
  x = (x & 0x0F0F0F0FU) << 4 | (x & 0xF0F0F0F0U) >> 4;
  x = (x & 0x33333333U) << 2 | (x & 0xCCCCCCCCU) >> 2;
  return (x & 0x55555555U) << 1 | (x & 0xAAAAAAAAU) >> 1;
}

// The columns of a Sobol matrix, already bit-reversed, from a primitive polynomial x^degree + ... + 1, whose inner
// coefficients are the bits of `inner`, and the first odd numbers m. [Sobol1967]
//   m_k = 2^s m_{k-s} ^ m_{k-s} ^ sum_i 2^i a_i m_{k-i}
constexpr Columns columns_of(int degree, std::uint32_t inner, std::array<std::uint32_t, 3> first) {
  std::array<std::uint64_t, kBits> m{};
  for (int k = 0; k < kBits; ++k) {
    const auto at = static_cast<std::size_t>(k);
    if (degree == 0) {
      m[at] = 1;
    } else if (k < degree) {
      m[at] = first[at];
    } else {
      const auto s = static_cast<std::size_t>(degree);
      m[at] = m[at - s] << degree ^ m[at - s];
      for (std::size_t i = 1; i < s; ++i)
        if ((inner >> (s - 1 - i) & 1U) != 0) m[at] ^= m[at - i] << i;
    }
  }
  Columns columns{};
  for (int k = 0; k < kBits; ++k) {
    const auto at = static_cast<std::size_t>(k);
    columns[at] = reversed(static_cast<std::uint32_t>(m[at] << (kBits - 1 - k)));
  }
  return columns;
}

// Dimension 0 is the radical inverse: its columns reversed are 1, 2, 4 ...
constexpr std::array<Columns, 4> kMatrixColumns = {columns_of(0, 0, {}), columns_of(1, 0, {1}),
                                                   columns_of(2, 1, {1, 3}), columns_of(3, 1, {1, 3, 1})};

// Bit-reversed coordinates in, bit-reversed coordinates out: every bit is flipped or not by a hash of the bits below it
// (those above it in the coordinate), which is Owen's nested scramble. Sums, products by odd numbers and x ^ (x * even)
// all keep to that order.
constexpr std::uint32_t scrambled(std::uint32_t x, std::uint32_t seed) {
  x += seed;
  x ^= x * 0x9A72E4D6U;
  x *= (seed >> 16) | 1U;
  x ^= x * 0x47C1B5AEU;
  x += seed >> 7 | seed << 25;
  x ^= x * 0xE3965F1CU;
  return x;
}

// The coordinates of an index before they are scrambled: the exclusive or of the columns of its bits, added to `x`.
using Coordinates = std::array<std::uint32_t, 4>;
constexpr Coordinates with_columns(std::uint32_t index, Coordinates x) {
  for (; index != 0; index &= index - 1)
    for (std::size_t d = 0; d < 4; ++d) x[d] ^= kMatrixColumns[d][static_cast<std::size_t>(std::countr_zero(index))];
  return x;
}

// Those of the first indices, which most sequences do not leave.
constexpr std::uint32_t kKnown = 64;
constexpr std::array<Coordinates, kKnown> kFirstCoordinates = [] {
  std::array<Coordinates, kKnown> first{};
  for (std::uint32_t i = 0; i < kKnown; ++i) first[i] = with_columns(i, {});
  return first;
}();

}  // namespace

Sequence::Set::Set(std::uint64_t seed, std::uint32_t set, std::uint32_t mask) : mask_(mask) {
  const std::uint64_t own = mixed(seed, set), other = mixed(own, 1), third = mixed(own, 2);
  seeds_ = {static_cast<std::uint32_t>(own), static_cast<std::uint32_t>(own >> 32), static_cast<std::uint32_t>(other),
            static_cast<std::uint32_t>(other >> 32)};
  order_ = static_cast<std::uint32_t>(third);
}

// Each set takes its points in an order of its own, itself an Owen scramble of the index, which leaves every block of
// 2^k points together.
std::array<double, 4> Sequence::Set::point(std::uint32_t index) const {
  const std::uint32_t shuffled = reversed(scrambled(reversed(index), order_)) & mask_;
  const Coordinates x = with_columns(shuffled & ~(kKnown - 1), kFirstCoordinates[shuffled % kKnown]);
  std::array<double, 4> point{};
  for (std::size_t d = 0; d < 4; ++d) point[d] = reversed(scrambled(x[d], seeds_[d])) * 0x1p-32;
  return point;
}

}  // namespace goniochrome::render
