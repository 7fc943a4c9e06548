// Work in three stages that run at once on things that come one by one: while one is worked on, the next is fetched and
// those before are finished. The things live in a fixed number of slots, which are used again and again, so that any
// number of them passes in constant memory.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace goniochrome {

template <class Slot>
struct Stages {
  std::function<bool(Slot&)> fetch;   // in order, on a thread of its own; false at the end
  std::function<bool(Slot&)> work;    // in order, on the thread of the caller; false ends all
  std::function<void(Slot&)> finish;  // out of order, on threads of its own
  std::function<bool(Slot&)> settle;  // in order, on the thread of the caller, after finish(); false ends all
};

namespace internal {

template <class Slot>
class Pipeline {
 public:
  Pipeline(std::vector<Slot>& slots, const Stages<Slot>& stages)
      : slots_(slots), stages_(stages), states_(slots.size(), State::kFree) {}

  void run(int finishers) {
    {
      Threads threads{*this, {}};
      threads.all.emplace_back([this] { keep_failure([this] { fetch_all(); }); });
      for (int i = 0; i < finishers; ++i) threads.all.emplace_back([this] { keep_failure([this] { finish_all(); }); });
      work_and_settle_all();
    }
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  enum class State { kFree, kFetched, kWorked, kFinished };

  // Threads that stop and end where the caller leaves, also by an exception.
  struct Threads {
    Pipeline& pipeline;
    std::vector<std::thread> all;
    ~Threads() {
      {
        const std::lock_guard<std::mutex> lock(pipeline.mutex_);
        pipeline.stopped_ = true;
      }
      pipeline.changed_.notify_all();
      for (std::thread& thread : all) thread.join();
    }
  };

  // Runs a thread; its exception ends all, and goes to the caller.
  void keep_failure(const std::function<void()>& thread) {
    try {
      thread();
    } catch (...) {
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        failure_ = std::current_exception();
      }
      changed_.notify_all();
    }
  }

  std::size_t place(std::size_t number) const { return number % slots_.size(); }
  State& state(std::size_t number) { return states_[place(number)]; }

  void put(std::size_t number, State next) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      state(number) = next;
    }
    changed_.notify_all();
  }

  void fetch_all() {
    for (std::size_t number = 0;; ++number) {
      {
        std::unique_lock<std::mutex> lock(mutex_);
        changed_.wait(lock, [&] { return stopped_ || state(number) == State::kFree; });
        if (stopped_) return;
      }
      if (stages_.fetch(slots_[place(number)])) {
        put(number, State::kFetched);
        continue;
      }
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        end_ = number, is_ended_ = true;
      }
      changed_.notify_all();
      return;
    }
  }

  void finish_all() {
    while (true) {
      std::size_t number = 0;
      {
        std::unique_lock<std::mutex> lock(mutex_);
        changed_.wait(lock, [&] { return stopped_ || to_finish_ < worked_; });
        if (stopped_) return;
        number = to_finish_++;
      }
      stages_.finish(slots_[place(number)]);
      put(number, State::kFinished);
    }
  }

  void work_and_settle_all() {
    for (std::size_t settled = 0;;) {
      bool to_settle = false;
      {
        std::unique_lock<std::mutex> lock(mutex_);
        changed_.wait(lock, [&] {
          return failure_ || (is_ended_ && settled == end_) ||
                 (settled < worked_ && state(settled) == State::kFinished) ||
                 (worked_ < settled + slots_.size() && state(worked_) == State::kFetched);
        });
        if (failure_ || (is_ended_ && settled == end_)) return;
        to_settle = settled < worked_ && state(settled) == State::kFinished;
      }
      if (to_settle) {
        if (!stages_.settle(slots_[place(settled)])) return;
        put(settled++, State::kFree);
        continue;
      }
      if (!stages_.work(slots_[place(worked_)])) return;
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        state(worked_) = State::kWorked;
        ++worked_;
      }
      changed_.notify_all();
    }
  }

  std::vector<Slot>& slots_;
  const Stages<Slot>& stages_;
  std::vector<State> states_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::size_t worked_ = 0;     // written by the caller's thread alone, under the lock
  std::size_t to_finish_ = 0;  // the next that a finisher takes
  std::size_t end_ = 0;
  bool is_ended_ = false, stopped_ = false;
  std::exception_ptr failure_;  // of a thread of its own
};

}  // namespace internal

// Passes all things through the stages, with `finishers` threads for the third one; without any, all runs on the thread
// of the caller, one thing after the other. `slots` has at least one, and several where stages are to run at once. An
// exception of any stage goes to the caller.
template <class Slot>
void run_stages(std::vector<Slot>& slots, int finishers, const Stages<Slot>& stages) {
  if (finishers > 0) {
    internal::Pipeline<Slot>(slots, stages).run(finishers);
    return;
  }
  for (Slot& slot = slots.front(); stages.fetch(slot);) {
    if (!stages.work(slot)) return;
    stages.finish(slot);
    if (!stages.settle(slot)) return;
  }
}

}  // namespace goniochrome
