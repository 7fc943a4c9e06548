#include "base/parallel.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>
#include <utility>
#include <vector>

#include "base/hard_case_for_test.h"

namespace goniochrome::parallel_test {
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

// How often one of eight threads, which need not be as many cores, began a chunk of the outer loop while it waited for
// its own inner loop in another. Chunks of the inner loop that other threads take from it last longer.
int chunks_begun_while_waiting(bool alone) {
  std::atomic<int> count = 0;
  tbb::task_arena threads(8);
  threads.execute([&] {
    parallel_for(64, 1, [&](std::size_t, std::size_t) {
      thread_local bool is_waiting = false;
      count += is_waiting ? 1 : 0;
      const auto inner = [owner = std::this_thread::get_id()] {
        parallel_for(4, 1, [&](std::size_t, std::size_t) {
          std::this_thread::sleep_for(std::chrono::microseconds(std::this_thread::get_id() == owner ? 20 : 2000));
        });
      };
      const bool before = std::exchange(is_waiting, true);
      if (alone)
        with_no_other_work(inner);
      else
        inner();
      is_waiting = before;
    });
  });
  return count;
}

// A thread that holds a lock while it waits must not begin what asks for that lock. The control is a loop by itself:
// some 10 of its 64 chunks are begun so.
TEST(Parallel, AThreadWithNoOtherWorkBeginsNoOtherChunk) {
  set_threads(8);
  int control = 0;
  for (int i = 0; i < 200 && control == 0; ++i) control = chunks_begun_while_waiting(false);
  EXPECT_GT(control, 0);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(chunks_begun_while_waiting(true), 0);
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
}  // namespace goniochrome::parallel_test
