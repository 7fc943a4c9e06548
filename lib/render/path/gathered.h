// Estimates of what a point shows, gathered round by round. goniochrome-paths(7), "Numbers".
#pragma once

#include <algorithm>
#include <cstdint>

#include "color/color.h"
#include "render/path/noise.h"
#include "render/path/reconstruction.h"
#include "render/path/transport.h"

namespace goniochrome::render {

// Samples are counted by fours, which are the fewest that can be traced.
constexpr int kOfFour = kHalfFan;

// A round of so many fours at a point. Two sequences tell a variance, and are as long as the round allows, because a
// longer sequence covers the hemisphere more evenly.
struct Round {
  static constexpr int kSequences = 2;
  int length = 1;  // of each sequence, in fours: a power of two

  // No more than asked for, but at least four of each sequence.
  explicit Round(int fours) {
    while (2 * length * kSequences <= fours) length *= 2;
  }
  int fours() const { return kSequences * length; }
  // Fours that are traced together: a fan, or a whole sequence if that is shorter.
  int together() const { return std::min(length, kFan / kOfFour); }
  int fans() const { return fours() / together(); }
  // The sequence that a fan belongs to, and the number of the fan's first sample in it.
  int sequence_of(int fan) const { return fan * together() / length; }
  std::uint32_t first_of(int fan) const { return static_cast<std::uint32_t>(kOfFour * (fan * together() % length)); }
};

// Independent estimates of what a point shows, gathered round by round. A round counts by its samples, whatever it
// found.
class Gathered {
 public:
  // The means over the sequences of a round.
  void add(const Round& round, const color::Rgb (&means)[Round::kSequences]) {
    Estimates of_round;
    for (const color::Rgb& mean : means) of_round.add(mean);
    const double before = fours_, added = round.fours(), all = before + added, share = added / all;
    for (std::size_t k = 0; k < halves_.size(); ++k) halves_[k] = (1 - share) * halves_[k] + share * means[k];
    const Covariance now = of_round.covariance();
    for (std::size_t k = 0; k < now.size(); ++k) {
      const double old = before > 0 ? (1 - share) * (1 - share) * of_four_[k] / before : 0;
      of_four_[k] = all * (old + share * share * now[k] / Round::kSequences);
    }
    fours_ += round.fours(), freedom_ += Round::kSequences - 1;
  }

  color::Rgb mean() const { return 0.5 * (halves_[0] + halves_[1]); }
  const Halves& halves() const { return halves_; }  // by the sequences of each round
  int fours() const { return fours_; }
  int freedom() const { return freedom_; }  // of the covariance
  // The covariance of the mean, times fours().
  const Covariance& of_four() const { return of_four_; }

 private:
  Halves halves_{};
  Covariance of_four_{};
  int fours_ = 0, freedom_ = 0;
};

// A point of a picture.
struct PointState {
  static constexpr std::uint32_t kNotSampled = ~0U;
  color::Rgb deterministic;             // what is known without samples of the light to be added to the base
  double needed = 0;                    // fours that bring the noise of the neighborhood to the tolerance
  std::uint32_t sampled = kNotSampled;  // its number among the SampledPoints
  bool certain = false;
  bool all_shares = false;      // Its first samples differ too much for any share to stop.
  bool hidden = false;          // most of its light: all that is left is summed, from which the base is taken
  std::uint16_t uncertain = 0;  // samples of the pixel whose light is not known without paths
  unsigned step = 1;            // from one sample of the pixel that rays look at to the next
  bool looked = false;          // what is seen and known without samples is known
};

// A point that gets samples; most points of a large picture get none.
struct SampledPoint {
  Gathered sums;
  color::Rgb floor_light;  // that needs no samples; one point stands for all that lie on one piece
  Halves kept{};           // of shares that stopped
};

}  // namespace goniochrome::render
