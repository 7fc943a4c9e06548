// Light from directions below the horizon, as means over parts of the hemisphere of any size.
// goniochrome-paths(7), "Open floor".
#pragma once

#include <vector>

#include "rays/float3.h"

namespace goniochrome::render {

// An image of the lower hemisphere by Lambert's azimuthal projection, on which equal areas are equal solid angles, and
// the same image at half of the size, a quarter, and so on. Immutable: for any number of threads at once.
class HemisphereMap {
 public:
  // size x size texels row by row, a power of two.
  HemisphereMap(int size, const std::vector<rays::Float3>& light);

  // The direction of a place on an image of so many texels across; none beyond the horizon, where texels must be those
  // of the nearest direction.
  struct Place {
    rays::Float3 direction;
    bool below = false;
  };
  static Place place(float column, float row, int size);
  static float texel_sr(int size) { return 8.0F / (static_cast<float>(size) * static_cast<float>(size)); }

  // The mean about a unit direction below the horizon, over about so much of the hemisphere. Between two sizes of the
  // image `number` in [0,1) chooses.
  rays::Float3 at(const rays::Float3& direction, float extent_sr, float number) const;

 private:
  struct Level {
    int size = 0;
    std::vector<rays::Float3> texels;
  };
  std::vector<Level> levels_;
};

}  // namespace goniochrome::render
