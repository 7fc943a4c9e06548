#include "base/parallel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/hard_case_for_test.h"

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

TEST(HardCase, ThreadsChunkedSumsAreBitIdentical) {
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
  double apart = 0;
  for (const int count : {2, 7}) {
    set_threads(count);
    apart = worst_of(apart, std::abs(sum() - one));
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
  const double ulp = std::nextafter(one, INFINITY) - one;
  hard_case("threads", {.what = "sums by 1, 2 and 7 threads",
                        .textbook = std::abs(shares(2) - shares(7)) / ulp,
                        .ours = apart / ulp,
                        .bound = 0,
                        .unit = "ulp"});
}

}  // namespace
}  // namespace goniochrome
