// Which side of a plane a cloud of points lies on, without looking at all of them.
#pragma once

#include <cstdint>
#include <vector>

#include "rays/float3.h"

namespace goniochrome::rays {

// Boxes of points in a balanced binary tree. Immutable.
class VertexTree {
 public:
  explicit VertexTree(std::vector<Float3> points);

  // True if a point lies more than `margin` above the plane through `origin` with this unit normal.
  bool any_above(const Float3& origin, const Float3& normal, float margin) const;

 private:
  struct Box {
    Float3 low, high;
  };
  void build(std::size_t node, std::size_t first, std::size_t last);

  std::vector<Float3> points_;
  std::vector<Box> boxes_;  // the children of i are 2 i + 1 and 2 i + 2
  std::size_t leaf_ = 0;    // the first node of the last level
  std::size_t in_leaf_ = 0;
};

}  // namespace goniochrome::rays
