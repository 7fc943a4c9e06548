// Rounds of samples at the points of a picture: how many each point is to get, and how a round ends in time.
// goniochrome-paths(7), "Numbers".
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include "base/clock.h"
#include "base/parallel.h"
#include "render/path/noise.h"

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

// Cuts a round, what each point is to get, so that no more than `left` are drawn in all, and returns true if any are.
// All points lose the same part, and what is too little to be drawn is passed on to the points that follow.
// `drawable(n)` returns the most that can be drawn of n. A round that the time limit broke off instead would leave some
// points with a fourth of the samples that others have.
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

// Calls draw(point) for each of these points, in chunks in a scattered order, so that a picture that time cut short is
// noisy evenly. Null: no clock ends the round.
template <class Draw>
void draw_round(const std::vector<std::uint32_t>& points, const Deadline* deadline, const Draw& draw) {
  constexpr std::size_t kTogether = 64;
  const std::size_t chunks = (points.size() + kTogether - 1) / kTogether, step = scattering(chunks);
  parallel_for(chunks, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (deadline != nullptr && deadline->passed()) return;
      const std::size_t first = i * step % chunks * kTogether;
      for (std::size_t k = first; k < std::min(points.size(), first + kTogether); ++k) draw(points[k]);
    }
  });
}

// The points of a picture by their pixels.
class PixelPoints {
 public:
  static constexpr int kReach = 2;  // of a neighborhood, to each side

  PixelPoints() = default;
  PixelPoints(int width, int height)
      : width_(width),
        height_(height),
        number_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), kNone) {}

  // Points are numbered as they are added.
  void add(int x, int y) { number_[place(x, y)] = count_++; }
  // Calls visit(number) for each point near a pixel, one in it among them.
  template <class Visit>
  void visit_around(int x, int y, const Visit& visit) const {
    visit_within(kReach, x, y, visit);
  }
  // So many pixels to each side.
  template <class Visit>
  void visit_within(int reach, int x, int y, const Visit& visit) const {
    for (int v = std::max(0, y - reach); v <= std::min(height_ - 1, y + reach); ++v)
      for (int u = std::max(0, x - reach); u <= std::min(width_ - 1, x + reach); ++u)
        if (number_[place(u, v)] != kNone) visit(std::size_t{number_[place(u, v)]});
  }

 private:
  static constexpr std::uint32_t kNone = ~0U;
  std::size_t place(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }

  int width_ = 0, height_ = 0;
  std::uint32_t count_ = 0;
  std::vector<std::uint32_t> number_;  // by pixel
};

// Few estimates tell little of their variance, and a point none of whose rays was occluded knows nothing of its
// neighbor's shadow: the mean over the neighborhood stands in. `around` is the sum over so many neighbors.
inline double smoothed_variance(double own, double freedom, double around, int neighbors) {
  constexpr double kNeighborhood = 4;  // The neighborhood counts as so many degrees of freedom.
  return (freedom * own + kNeighborhood * (around + own) / (neighbors + 1)) / (freedom + kNeighborhood);
}

// All specks get such a part of all samples or, where few points have any, as many for each point.
constexpr double kSpecksShare = 0.5;
// Most points need no more than a few samples: the first round takes as many fours as tell a variance.
constexpr int kFirstFours = 2;
// The samples of a pixel are first looked at, which took about as long as so many fours of a car in two probes.
constexpr double kFoursOfLook = 2;
// The first samples of a point may all miss a small light: what no neighbor tells counts as if it needed so many fours.
constexpr double kAlone = 32;

// An error of so many tolerances is a speck. Its point gets at most so many times its samples.
constexpr double kSpeck = 2, kMostOfSpeck = 15;
// An error of the own samples of a point of so many tolerances is seen once filters spread it: a disc of 25 pixels on a
// hood went with 10, and a fourth of its light stayed with 30.
constexpr double kBlotch = 10;

// True if the squared error of a point is above so many times the mean of those about its pixel, its own among them.
// Points without samples have 0, and do not count. With 4 and 8 three pictures were alike; 16 took a round more in one.
inline bool is_rare(const PixelPoints& points, int x, int y, const std::vector<double>& squares, double own) {
  constexpr double kRare = 4;
  double sum = 0;
  int count = 0;
  points.visit_around(x, y, [&](std::size_t i) { sum += squares[i], count += squares[i] > 0 ? 1 : 0; });
  return own * count > kRare * sum;
}

// The samples that bring the error of a reconstructed point to the tolerance, of which it has so many.
inline double needed_samples(double has, double error_de00, double spike_de00, double tolerance_de00) {
  const double excess = kDeviations * error_de00 / tolerance_de00;
  const double speck = spike_de00 > kBlotch * tolerance_de00 ? kSpeck * kSpeck * (1 + kMostOfSpeck) : 0;
  return has * std::max(excess * excess, speck);
}

// A round draws no less than this part of all samples so far: after each the noise of every point is judged anew, which
// takes the time of a fan for every twenty points.
constexpr double kLeastRound = 1.0 / 16;

struct RoundLimits {
  double of_point = 0;        // that a point has in all
  double typical = 0;         // The points that need more than most others get no more than this asks for.
  double lacking = 1;         // noise of the picture, in its aim
  double least = 1;           // of the round
  double at_once = HUGE_VAL;  // of a point
  bool in_vain = false;       // Nothing is scaled, because more samples would not reach the aim.
};

// How many samples each point is to get next: needed(point) less those that it has, at most three times these. Where
// the points are content but the picture is not, or would draw too little for a round, all is scaled by what it lacks.
// Returns true if any point gets some.
template <class Needed, class Has>
bool plan_round(const RoundLimits& limits, const Needed& needed, const Has& has, std::vector<int>& more) {
  constexpr double kGrowth = 3;
  for (double scale = 1;; scale *= 1.1 * std::max(1.0, limits.lacking * limits.lacking)) {
    const double most = std::min(std::ceil(1.05 * scale * limits.typical), limits.of_point);
    double asked = 0;
    bool limited = true;
    for (std::size_t i = 0; i < more.size(); ++i) {
      const double n = has(i), wanted = std::min(std::ceil(scale * needed(i)), most) - n;
      more[i] = static_cast<int>(std::clamp(wanted, 0.0, std::min(kGrowth * n, limits.at_once)));
      asked += more[i];
      limited = limited && (needed(i) == 0 || n >= limits.of_point);
    }
    if (asked >= limits.least) return true;
    if (limits.in_vain) return false;
    if (limited || scale > 1e6) return asked > 0;
  }
}

}  // namespace goniochrome::render
