// Clocks, time limits, and the memory that a process has used, for reports and for stopping in time.
#pragma once

#include <chrono>

namespace goniochrome {

// Seconds since construction.
class Stopwatch {
 public:
  double elapsed_s() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// A time limit in seconds from construction; 0 or less means none.
class Deadline {
 public:
  explicit Deadline(double limit_s = 0) : limit_s_(limit_s) {}
  bool passed() const { return limit_s_ > 0 && clock_.elapsed_s() >= limit_s_; }
  double limit_s() const { return limit_s_; }
  // Seconds until the limit; negative once it has passed. Meaningless without a limit.
  double left_s() const { return limit_s_ - clock_.elapsed_s(); }

 private:
  double limit_s_;
  Stopwatch clock_;
};

// The largest resident set of this process so far, in MB (2^20 bytes).
double peak_rss_mb();

}  // namespace goniochrome
