// Countless flakes as a tree of counts. The flakes of a plane are a Poisson process over their place and their tilt. A
// node of the tree is a box of both, and its count is shared out between its two halves by a binomial draw whose random
// bits are a hash of the node. So a box always holds the same flakes, seen from near or far, in any order and by any
// number of threads. goniochrome-flakes(7), "COUNTS".
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace goniochrome::brdf {

// A box of flakes: the place in the plane, in meters; then the tilt by two coordinates in [0,1), over which flakes are
// even, of which the second is an angle in turns and may pass 1; and the part of these flakes that are shown.
struct FlakeBox {
  std::array<double, 2> place = {}, size = {1, 1};
  std::array<double, 2> tilt = {}, tilts = {1, 1};
  double shown = 1;

  double area() const { return size[0] * size[1]; }
  double part() const { return tilts[0] * tilts[1] * shown; }  // of the flakes on that area
};

// The flakes of a box, and those of them within another.
struct FlakeCounts {
  double all = 0, inner = 0;

  FlakeCounts& operator+=(const FlakeCounts& other) {
    all += other.all, inner += other.inner;
    return *this;
  }
};

class FlakeTree {
 public:
  struct Flake {
    std::array<double, 2> place, tilt;
  };

  // `density` flakes a square meter. Trees of other seeds hold other flakes. Boxes are found fastest that have about
  // the part `tilts` (above 0) of all tilts.
  FlakeTree(double density, std::uint64_t seed, double tilts = 1);

  // The number of flakes in the box: Poisson with the mean density * area() * part(), for any two boxes that do not
  // meet independent. Boxes much wider than a tile have their mean, from which the count of all their flakes differs by
  // 2e-4.
  double count(const FlakeBox& box) const { return counts(box, box).all; }
  // The flakes of the box, and those of them whose angle is in the range of `inner`, which lies in that of the box:
  // given the former, the latter are binomial.
  FlakeCounts counts(const FlakeBox& box, const FlakeBox& inner) const;
  // The flakes of a box one by one; for a box with few of them. All of them are shown.
  std::vector<Flake> flakes(const FlakeBox& box) const;

 private:
  struct Corners;
  struct Node;
  template <class Visit>
  void visit_tiles(const FlakeBox& box, const Visit& visit) const;
  Node root(std::int64_t column, std::int64_t row) const;

  double density_, tile_m_;
  std::uint64_t seed_;
  int tilt_splits_;
};

// Draws by inversion, from a number in (0,1): monotone in it, and in the mean.
double poisson_draw(double mean, double u);
double binomial_draw(double count, double part, double u);

}  // namespace goniochrome::brdf
