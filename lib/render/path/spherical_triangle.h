// A triangle as a point sees it, whose directions are drawn evenly. goniochrome-paths(7), "Emitters".
#pragma once

#include <array>

#include "base/vec3.h"
#include "rays/float3.h"

namespace goniochrome::render {

// The great triangle on the unit sphere about a point onto which a flat one is projected.
class SphericalTriangle {
 public:
  SphericalTriangle(const rays::Float3& from, const std::array<rays::Float3, 3>& corner);

  // Its solid angle in sr, up to 2 pi; 0 where the point lies in the plane of the triangle, beside it.
  double extent_sr() const { return extent_sr_; }
  // A direction drawn evenly by numbers in [0,1). Only of an extent above 0.
  Vec3 direction(double u, double v) const;

 private:
  Vec3 a_, b_, c_;                    // directions of the corners, unit
  double extent_sr_ = 0, angle_ = 0;  // the latter is the one at a
  double cos_angle_ = 0, sin_angle_ = 0, cos_ab_ = 0;
};

}  // namespace goniochrome::render
