// The dielectric node of MaterialX, of which Standard Surface and OpenPBR are made.
#pragma once

#include "base/vec3.h"

namespace goniochrome::materials {

// The index whose reflectance along the normal is the strength, 0 to 0.9.
double index_of(double strength);

// The reflectance of a dielectric node, in 1/sr, and the light that the node layer leaves to the one below.
struct DielectricLayer {
  double reflected = 0, left = 1;
};
DielectricLayer dielectric_layer(double weight, double index, double alpha, const Vec3& light, const Vec3& view);

}  // namespace goniochrome::materials
