// An environment may be turned about the scene; this is the turn, which takes directions from one to the other.
#pragma once

#include <cmath>

#include "base/vec3.h"

namespace goniochrome::envmap {

class Rotation {
 public:
  Rotation() = default;

  // About +Y (positive takes +Z toward +X), then about +X, then about +Z, right-handed; radians.
  static Rotation about_axes(double y_rad, double x_rad, double z_rad) {
    const double cy = std::cos(y_rad), sy = std::sin(y_rad), cx = std::cos(x_rad), sx = std::sin(x_rad);
    const double cz = std::cos(z_rad), sz = std::sin(z_rad);
    const auto turned = [&](Vec3 d) {
      d = {cy * d.x + sy * d.z, d.y, cy * d.z - sy * d.x};
      d = {d.x, cx * d.y - sx * d.z, sx * d.y + cx * d.z};
      return Vec3{cz * d.x - sz * d.y, sz * d.x + cz * d.y, d.z};
    };
    Rotation r;
    r.x_ = turned({1, 0, 0}), r.y_ = turned({0, 1, 0}), r.z_ = turned({0, 0, 1});
    r.identity_ = y_rad == 0 && x_rad == 0 && z_rad == 0;
    return r;
  }

  bool is_identity() const { return identity_; }
  // From the environment's own frame to the scene's, and back.
  Vec3 to_world(const Vec3& d) const { return identity_ ? d : d.x * x_ + d.y * y_ + d.z * z_; }
  Vec3 to_environment(const Vec3& d) const { return identity_ ? d : Vec3{dot(d, x_), dot(d, y_), dot(d, z_)}; }

 private:
  Vec3 x_ = {1, 0, 0}, y_ = {0, 1, 0}, z_ = {0, 0, 1};  // where the environment's axes go
  bool identity_ = true;
};

}  // namespace goniochrome::envmap
