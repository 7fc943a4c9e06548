// A point to be shaded alone.
#pragma once

#include "base/vec3.h"

namespace goniochrome {

struct VisiblePoint {
  Vec3 normal, to_viewer;  // unit, on the same side
  int part = 0;
};

}  // namespace goniochrome
