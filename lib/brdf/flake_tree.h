// Countless flakes as trees of counts. The flakes of a plane are a Poisson process over their place and their tilt. A
// node of a tree is a square of places, and its count is shared out between its two halves by a binomial draw whose
// random bits are a hash of the node. So a box always holds the same flakes, seen from near or far, in any order and by
// any number of threads. goniochrome-flakes(7), "COUNTS".
#pragma once

#include <array>
#include <cstdint>

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

class FlakeTree {
 public:
  // `density` flakes a square meter. Trees of other seeds hold other flakes.
  FlakeTree(double density, std::uint64_t seed) : density_(density), seed_(seed) {}

  // The number of flakes in the box: Poisson with the mean density * area() * part(), for any two boxes that do not
  // meet independent. Ranges of tilts of which one is twice as wide hold other flakes. Boxes of more than some 2e6
  // flakes, or of 3e3 in a narrow range of tilts, have their mean.
  double count(const FlakeBox& box) const;

 private:
  double density_;
  std::uint64_t seed_;
};

// Draws by inversion, from a number in (0,1): monotone in it, and in the mean.
double poisson_draw(double mean, double u);
double binomial_draw(double count, double part, double u);

}  // namespace goniochrome::brdf
