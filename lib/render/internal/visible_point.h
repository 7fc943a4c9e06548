// A point to be shaded alone.
#pragma once

#include "base/vec3.h"

namespace goniochrome::render {

struct TexturePlace {
  float u = 0, v = 0;
  float tangent[3] = {0, 0, 0};  // world, along u; of about unit length, or 0 where it is not known
};

struct VisiblePoint {
  Vec3 normal, to_viewer;  // unit, on the same side
  int part = 0;
  bool placed = false;  // whether its place on a texture is known
  TexturePlace place = {};
};

}  // namespace goniochrome::render
