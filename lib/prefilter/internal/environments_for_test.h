// Environments for the tests of this room.
#pragma once

#include <random>
#include <vector>

#include "envmap/environment.h"

namespace goniochrome::prefilter {

// A lat-long map with a sun in one texel, and a cube.
inline std::vector<envmap::Environment> environments() {
  std::mt19937 random(8);
  std::lognormal_distribution<float> contrast(0, 1.5F);
  image::Image image = {160, 80, 3, {}, {}};
  for (int i = 0; i < 160 * 80 * 3; ++i) image.data.push_back(contrast(random));
  image.pixel(40, 20)[0] = image.pixel(40, 20)[1] = 1e5F;
  std::vector<envmap::Environment> all;
  all.push_back(envmap::Environment::from_lat_long(image, envmap::Environment::BadPixels::kError, "flat").value());
  envmap::CubeMap map(45);
  for (float& v : map.texels) v = contrast(random);
  all.push_back(envmap::Environment::from_cube(map, "cube"));
  return all;
}

}  // namespace goniochrome::prefilter
