#include "base/child.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <memory>
#include <new>
#include <stdexcept>
#include <thread>
#include <vector>

#include "base/clock.h"
#include "base/parallel.h"

namespace goniochrome::child_test {
namespace {

using testing::HasSubstr;

constexpr ChildLimits kLimits = {std::size_t{64} << 20, 1};

std::string error_of(const std::function<Result<void>(ChildOutput&)>& work) {
  const auto bytes = made_by_child("x.ply", kLimits, work);
  return bytes.ok() ? "no error" : bytes.error().message;
}

TEST(Child, HandsItsBytesOver) {
  std::string text(100000, 'a');
  for (std::size_t i = 0; i < text.size(); ++i) text[i] = static_cast<char>(i * 7);
  const auto bytes = made_by_child("x", kLimits, [&](ChildOutput& output) -> Result<void> {
    output.write(text.data(), 1000);
    output.write(text.data() + 1000, text.size() - 1000);
    return {};
  });
  ASSERT_TRUE(bytes.ok()) << bytes.error().message;
  EXPECT_EQ(bytes->view(), text);
  const auto none = made_by_child("x", kLimits, [](ChildOutput&) -> Result<void> { return {}; });
  ASSERT_TRUE(none.ok());
  EXPECT_TRUE(none->view().empty());
}

TEST(Child, ThatCannotStartAThreadIsToldByItsParent) {
  EXPECT_THAT(error_of([](ChildOutput&) -> Result<void> {
                end_child_without_thread();
                return {};
              }),
              HasSubstr("x.ply: cannot be read: no thread can be started"));
  end_child_without_thread();  // a process that is no child goes on
}

TEST(Child, WhateverEndsItIsAnErrorThatNamesTheFile) {
  for (const int number : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL})
    EXPECT_THAT(error_of([&](ChildOutput&) -> Result<void> {
                  raise(number);
                  return {};
                }),
                HasSubstr("x.ply: the library that reads it crashed on it"));
  EXPECT_THAT(error_of([](ChildOutput&) -> Result<void> { std::exit(7); }), HasSubstr("x.ply: "));
  EXPECT_THAT(error_of([](ChildOutput&) -> Result<void> { throw std::runtime_error("so"); }),
              HasSubstr("x.ply: the library that reads it gave up: so"));
  EXPECT_THAT(error_of([](ChildOutput&) -> Result<void> { throw 1; }), HasSubstr("x.ply: "));
}

TEST(Child, ItsOwnErrorsComeBackWhole) {
  const auto bytes = made_by_child("x", kLimits, [](ChildOutput& output) -> Result<void> {
    output.write("half", 4);
    return Error{ErrorKind::kLimit, "x:3: so"};
  });
  ASSERT_FALSE(bytes.ok());
  EXPECT_EQ(bytes.error().message, "x:3: so");
  EXPECT_EQ(bytes.error().kind, ErrorKind::kLimit);
}

#if !defined(__SANITIZE_ADDRESS__)
TEST(Child, MemoryBeyondTheLimitIsAnError) {
  EXPECT_THAT(error_of([](ChildOutput&) -> Result<void> {
                std::vector<char> much(std::size_t{1} << 30, 'x');
                return much[7] == 'x' ? Result<void>() : Result<void>(input_error("none"));
              }),
              HasSubstr("64 MB"));
}

// Libraries that ignore a null from malloc() crash: the error names the memory, and not a damaged file.
TEST(Child, CrashForWantOfMemoryIsToldAsThat) {
  for (const int number : {SIGABRT, SIGSEGV})
    EXPECT_THAT(error_of([&](ChildOutput&) -> Result<void> {
                  std::vector<std::unique_ptr<char[]>> all;
                  for (;;) {
                    char* more = new (std::nothrow) char[1 << 20];
                    if (more == nullptr) break;
                    all.emplace_back(more);
                  }
                  raise(number);
                  return {};
                }),
                HasSubstr("64 MB"));
}
#endif

TEST(Child, TimeBeyondTheLimitIsAnError) {
  EXPECT_THAT(error_of([](ChildOutput&) -> Result<void> {
                std::atomic<int> turns = 0;
                for (;;) ++turns;
              }),
              HasSubstr("took more than 1 s"));
}

// It uses no processor time, and neither an alarm nor SIGTERM reaches it.
TEST(Child, WaitingWithEverySignalBlockedIsEnded) {
  const auto waiting = made_by_child("stuck.ppm", {kLimits.memory_bytes, 1, 2}, [](ChildOutput&) -> Result<void> {
    sigset_t all;
    sigfillset(&all);
    sigprocmask(SIG_SETMASK, &all, nullptr);
    for (;;) pause();
  });
  ASSERT_FALSE(waiting.ok());
  EXPECT_EQ(waiting.error().message, "stuck.ppm: reading it took more than 1 s: is it damaged?");
}

TEST(Child, ChangesNothingHere) {
  int value = 1;
  EXPECT_EQ(error_of([&](ChildOutput&) -> Result<void> {
              value = 2;
              return {};
            }),
            "no error");
  EXPECT_EQ(value, 1);
}

// A child whose parent has threads of parallel_for, which free what they had while the process is doubled.
TEST(Child, CanBeMadeRightAfterALoop) {
  set_threads(4);
  for (int i = 0; i < 40; ++i) {
    parallel_for(200, 1, [](std::size_t begin, std::size_t) { std::vector<char> much(1000 * (begin % 60 + 1)); });
    EXPECT_EQ(error_of([&](ChildOutput& output) -> Result<void> {
                const std::vector<char> bytes(1 << 16);
                output.write(bytes.data(), bytes.size());
                return {};
              }),
              "no error");
  }
  set_threads(0);
}

#if !defined(__SANITIZE_ADDRESS__)
// Under the sanitizer such a child may wait for ever for a lock of the sanitizer's allocator.
TEST(Child, CanBeMadeWhileOtherThreadsAllocate) {
  std::vector<std::jthread> others;
  for (int t = 0; t < 3; ++t)
    others.emplace_back([](std::stop_token stop) {
      for (std::size_t n = 1; !stop.stop_requested(); n = n * 5 % 65521) std::vector<char> much(n);
    });
  for (int i = 0; i < 50; ++i)
    EXPECT_EQ(error_of([&](ChildOutput& output) -> Result<void> {
                const std::vector<char> bytes(1 << 16);
                output.write(bytes.data(), bytes.size());
                return {};
              }),
              "no error");
}
#endif

// A figure for who reads it: what a file that is read by a child costs more.
TEST(Child, TellsWhatItCosts) {
  std::vector<double> took;
  for (int i = 0; i < 51; ++i) {
    const Stopwatch clock;
    EXPECT_TRUE(made_by_child("x", kLimits, [](ChildOutput&) -> Result<void> { return {}; }).ok());
    took.push_back(1e3 * clock.elapsed_s());
  }
  std::sort(took.begin(), took.end());
  RecordProperty("median_ms", std::to_string(took[25]));
  fmt::print("a child takes {:.2f} ms (median of {})\n", took[25], took.size());
}

}  // namespace
}  // namespace goniochrome::child_test
