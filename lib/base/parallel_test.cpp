#include "base/parallel.h"

#include <gtest/gtest.h>

#include <vector>

namespace goniochrome {
namespace {

TEST(Parallel, EveryIndexOnceWhateverTheThreads) {
  for (const int count : {1, 2, 7}) {
    set_threads(count);
    for (const std::size_t n : {0u, 1u, 10u, 1001u}) {
      std::vector<int> visits(n, 0);
      parallel_for(n, 10, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) ++visits[i];
      });
      EXPECT_EQ(visits, std::vector<int>(n, 1));
    }
  }
  set_threads(0);
}

TEST(HardCase, threads_chunked_sums_are_bit_identical) {
  std::vector<double> terms(100000);
  for (std::size_t i = 0; i < terms.size(); ++i) terms[i] = 1.0 / static_cast<double>(3 * i + 1);
  const auto sum = [&] {
    constexpr std::size_t kChunk = 1000;
    std::vector<double> partial(terms.size() / kChunk, 0.0);
    parallel_for(terms.size(), kChunk, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) partial[begin / kChunk] += terms[i];
    });
    double total = 0;
    for (const double p : partial) total += p;
    return total;
  };
  set_threads(1);
  const double one = sum();
  for (const int count : {2, 7}) {
    set_threads(count);
    EXPECT_EQ(sum(), one);
  }
  set_threads(0);
  // The control: the same terms split in 2 and in 7 shares do not add up to the same bits.
  const auto shares = [&](std::size_t count) {
    double total = 0;
    for (std::size_t s = 0; s < count; ++s) {
      double partial = 0;
      for (std::size_t i = s * terms.size() / count; i < (s + 1) * terms.size() / count; ++i) partial += terms[i];
      total += partial;
    }
    return total;
  };
  EXPECT_NE(shares(2), shares(7));
}

}  // namespace
}  // namespace goniochrome
