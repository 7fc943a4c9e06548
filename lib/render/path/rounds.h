// Rounds of samples that end in time. goniochrome-paths(7), "Numbers".
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "base/clock.h"

namespace goniochrome::render {

// How fast samples are drawn, by the last round, and how many there is time for.
class Pace {
 public:
  explicit Pace(const Deadline& deadline) : deadline_(deadline) {}
  void start() { round_ = Stopwatch(); }
  void end(double drawn) { per_s_ = drawn / std::max(round_.elapsed_s(), 1e-9); }
  // Beside what takes `reserved_s` after a round.
  double left(double reserved_s = 0) const {
    return deadline_.limit_s() > 0 ? per_s_ * (deadline_.left_s() - reserved_s) : HUGE_VAL;
  }

 private:
  const Deadline& deadline_;
  Stopwatch round_;
  double per_s_ = 0;
};

// Cuts a round, what each point is to get, so that no more than `left` are drawn in all; whether any are. All points
// lose the same part, and what is too little to be drawn is passed on to the points that follow. `drawable(n)`: the
// most that can be drawn of n. A round that the time limit broke off instead would leave some points with a fourth of
// the samples that others have.
template <class Drawable>
bool cut_round(double left, std::vector<int>& more, const Drawable& drawable) {
  const double asked = std::accumulate(more.begin(), more.end(), 0.0);
  if (left >= asked) return true;
  double due = 0;
  bool any = false;
  for (int& n : more) {
    due += std::max(0.0, left) / asked * n;
    n = drawable(std::min(n, static_cast<int>(due)));
    due -= n, any = any || n > 0;
  }
  return any;
}

// A step near the golden section of n that shares no factor with it: its multiples visit n chunks in a scattered order.
inline std::size_t scattering(std::size_t n) {
  auto step = static_cast<std::size_t>(0.6180339887 * static_cast<double>(n)) + 1;
  while (n > 1 && std::gcd(step, n) != 1) ++step;
  return step;
}

}  // namespace goniochrome::render
