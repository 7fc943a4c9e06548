#include "base/pipeline.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <new>
#include <numeric>

namespace goniochrome::pipeline_test {
namespace {

struct Slot {
  int number = 0, doubled = 0, squared = 0;
};

struct Passed {
  std::vector<int> worked, settled;
};

// Numbers 0..count-1, of which the finishing of some takes longer.
Passed passed(int count, int finishers, std::size_t slots_there, int stop_at = -1) {
  Passed result;
  int next = 0;
  std::vector<Slot> slots(slots_there);
  Stages<Slot> stages;
  stages.fetch = [&](Slot& slot) {
    slot = {next, 0, 0};
    return next++ < count;
  };
  stages.work = [&](Slot& slot) {
    result.worked.push_back(slot.number);
    slot.doubled = 2 * slot.number;
    return slot.number != stop_at;
  };
  stages.finish = [](Slot& slot) {
    if (slot.number % 3 == 0) std::this_thread::sleep_for(std::chrono::microseconds(200));
    slot.squared = slot.doubled * slot.doubled;
  };
  stages.settle = [&](Slot& slot) {
    result.settled.push_back(slot.squared);
    return true;
  };
  run_stages(slots, finishers, stages);
  return result;
}

TEST(Pipeline, PassesAllInOrderWhateverItsThreadsAndSlots) {
  std::vector<int> numbers(200), squares;
  std::iota(numbers.begin(), numbers.end(), 0);
  for (const int n : numbers) squares.push_back(4 * n * n);
  for (const int finishers : {0, 1, 2, 5})
    for (const std::size_t slots : {1, 2, 3, 8}) {
      const Passed got = passed(200, finishers, slots);
      EXPECT_EQ(got.worked, numbers) << finishers << " finishers, " << slots << " slots";
      EXPECT_EQ(got.settled, squares) << finishers << " finishers, " << slots << " slots";
    }
}

TEST(Pipeline, EndsWithNothingToDo) {
  for (const int finishers : {0, 2}) EXPECT_TRUE(passed(0, finishers, 4).settled.empty());
}

TEST(Pipeline, StopsWhereAStageSaysSo) {
  for (const int finishers : {0, 1, 3}) {
    const Passed got = passed(1000, finishers, 4, 17);
    EXPECT_EQ(got.worked.size(), 18u);
    EXPECT_LE(got.settled.size(), 17u);
  }
}

TEST(Pipeline, HandsTheExceptionOfAnyStageToTheCaller) {
  for (const int finishers : {0, 1, 3})
    for (int failing = 0; failing < 4; ++failing) {
      int next = 0;
      std::vector<Slot> slots(4);
      const auto stage = [failing](int place) {
        return [=](Slot& slot) {
          if (place == failing && slot.number == 9) throw std::bad_alloc();
          return true;
        };
      };
      Stages<Slot> stages;
      stages.fetch = [&](Slot& slot) {
        slot.number = next++;
        return stage(0)(slot) && next < 1000;
      };
      stages.work = stage(1), stages.finish = stage(2), stages.settle = stage(3);
      EXPECT_THROW(run_stages(slots, finishers, stages), std::bad_alloc)
          << finishers << " finishers, stage " << failing;
    }
}

// No more things are on their way than there are slots.
TEST(Pipeline, HoldsNoMoreThanItsSlots) {
  std::atomic<int> alive = 0, most = 0;
  int next = 0;
  std::vector<Slot> slots(3);
  Stages<Slot> stages;
  stages.fetch = [&](Slot&) {
    if (next++ >= 300) return false;
    const int now = ++alive;
    if (now > most) most = now;
    return true;
  };
  stages.work = [](Slot&) { return true; };
  stages.finish = [](Slot&) {};
  stages.settle = [&](Slot&) {
    --alive;
    return true;
  };
  run_stages(slots, 2, stages);
  EXPECT_EQ(alive, 0);
  EXPECT_LE(most, 3);
}

}  // namespace
}  // namespace goniochrome::pipeline_test
