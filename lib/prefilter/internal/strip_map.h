// Sums over texels of a lat-long map whose weights depend on nothing but the direction that is asked for.
//
// Directions that lie alike to the texels have the same weights, which are found once. These are directions that are
// whole columns apart or mirror images of each other, up and down or left and right: a cube of maps whose axis is that
// of the environment has up to sixteen of them. goniochrome-prefiltering(7), "Orbits".
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "base/vec3.h"
#include "envmap/environment.h"

namespace goniochrome::prefilter {

// Some texels and their weights, as runs within rows that are cut into strips of equal length.
class Strips {
 public:
  void clear() { row_starts_.clear(), columns_.clear(); }
  // The texels of a row from `column` on, which do not reach beyond its end.
  void add(int row, int column, const float* weights, std::size_t columns);

 private:
  friend class StripMap;
  explicit Strips(int stride) : stride_(stride) {}

  int stride_;                             // texels from one row of the map to the next
  std::vector<int> row_starts_, columns_;  // of the first texel of each strip
  // The weights of the texels; `backward_` has every strip from its last texel to its first.
  std::vector<float> forward_, backward_;
};

class StripMap {
 public:
  // The rest of a clipped lat-long map, which has fewer than 2^31 texels.
  StripMap(const envmap::Environment& env, const envmap::Clip& clip);

  // A direction of the northern hemisphere at the place `column` of the first half of the first column, continuously.
  struct Seat {
    Vec3 d;
    double column;
  };
  // Adds the texels of a seat to strips that are empty.
  using Weigh = std::function<void(const Seat& seat, Strips& strips)>;
  // The weighted sum of the texels for each direction. Weights are floats, so that a sum errs by 1e-7 of its terms.
  std::vector<Vec3> sums(const std::vector<Vec3>& directions, const Weigh& weigh) const;

 private:
  // A direction as it was given, in terms of its seat: below the equator, with the columns the other way round, and so
  // many columns on.
  struct Member {
    std::size_t index;
    bool below, reversed;
    int shift;
  };
  struct Orbit {
    Seat seat;
    std::vector<Member> members;
  };
  std::vector<Orbit> orbits_of(const std::vector<Vec3>& directions) const;
  Vec3 sum_for(const Member& member, const Strips& strips, std::vector<int>& at) const;

  int width_ = 0, height_ = 0, stride_ = 0;
  std::vector<float> rgb_;  // rows of stride_ texels; the first of a row follow its last once more
};

}  // namespace goniochrome::prefilter
