#include "rays/internal/vertex_tree.h"

#include <algorithm>
#include <limits>

namespace goniochrome::rays {

namespace {

constexpr std::size_t kMostInLeaf = 8;

float coordinate(const Float3& p, int axis) {
  return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
}

}  // namespace

VertexTree::VertexTree(std::vector<Float3> points) : points_(std::move(points)) {
  std::size_t leaves = 1;
  while (leaves * kMostInLeaf < points_.size()) leaves *= 2;
  leaf_ = leaves - 1;
  boxes_.resize(2 * leaves - 1);
  in_leaf_ = (points_.size() + leaves - 1) / leaves;
  build(0, 0, leaves);
}

// The node holds the leaves [first, last); each leaf has as many points as any other, but those at the end.
void VertexTree::build(std::size_t node, std::size_t first, std::size_t last) {
  constexpr float kFar = std::numeric_limits<float>::infinity();
  const std::size_t begin = std::min(first * in_leaf_, points_.size()), end = std::min(last * in_leaf_, points_.size());
  Box box{{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
  for (std::size_t i = begin; i < end; ++i) {
    const Float3& p = points_[i];
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
  }
  boxes_[node] = box;
  if (last - first == 1) return;
  const Float3 size = box.high - box.low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const std::size_t half = (first + last) / 2, middle = std::min(half * in_leaf_, end);
  if (middle < end)
    std::nth_element(points_.begin() + static_cast<std::ptrdiff_t>(begin),
                     points_.begin() + static_cast<std::ptrdiff_t>(middle),
                     points_.begin() + static_cast<std::ptrdiff_t>(end),
                     [axis](const Float3& a, const Float3& b) { return coordinate(a, axis) < coordinate(b, axis); });
  build(2 * node + 1, first, half);
  build(2 * node + 2, half, last);
}

bool VertexTree::any_above(const Float3& origin, const Float3& normal, float margin) const {
  const float level = dot(normal, origin) + margin;
  const auto top = [&](std::size_t node) {
    const Box& box = boxes_[node];
    return normal.x * (normal.x > 0 ? box.high.x : box.low.x) + normal.y * (normal.y > 0 ? box.high.y : box.low.y) +
           normal.z * (normal.z > 0 ? box.high.z : box.low.z);
  };
  // Depth first, the higher child first: 64 levels would hold more points than memory does.
  std::size_t stack[64];
  int waiting = 0;
  stack[waiting++] = 0;
  while (waiting > 0) {
    const std::size_t node = stack[--waiting];
    if (!(top(node) > level)) continue;
    if (node < leaf_) {
      const std::size_t a = 2 * node + 1, b = a + 1;
      const bool a_higher = top(a) > top(b);
      stack[waiting++] = a_higher ? b : a;
      stack[waiting++] = a_higher ? a : b;
      continue;
    }
    const std::size_t begin = (node - leaf_) * in_leaf_, end = std::min(begin + in_leaf_, points_.size());
    for (std::size_t i = begin; i < end; ++i)
      if (dot(normal, points_[i]) > level) return true;
  }
  return false;
}

}  // namespace goniochrome::rays
