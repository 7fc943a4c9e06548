// Colors outside of Rec.709, for files that can hold no light below 0.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "color/color.h"

namespace goniochrome::materials {

// The nearest color of Rec.709 by CIEDE2000. A search for each color would take 20 us; the colors of a paint are near
// each other, so that one is made for each corner of a lattice in Lab that is asked for, and kept.
class NearestInRec709 {
 public:
  // `white` is that of the condition which the paint is seen in.
  explicit NearestInRec709(const color::Xyz& white);

  // `f` in 1/sr and the result are in the working space. A color of Rec.709 is itself.
  color::Rgb operator()(const color::Rgb& f);

 private:
  static constexpr double kStep = 2.5;  // of the lattice, in L*, a* and b*
  static constexpr std::size_t kLightness = 43, kHue = 112;

  Vec3 corner(std::size_t lightness, std::size_t a, std::size_t b);

  color::Xyz white_;
  // The difference of the nearest color in L*, a* and b*, and whether it is known.
  struct Corner {
    std::array<float, 3> difference;
    bool known = false;
  };
  std::vector<Corner> corners_;
};

}  // namespace goniochrome::materials
