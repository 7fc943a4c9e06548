// A grid over the directions to viewers and, for each of them, over the normals that face it. What changes slowly with
// both is told at its nodes and is linear between them. goniochrome-rendering(7), "Sums".
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "base/vec3.h"

namespace goniochrome::render {

class ViewGrid {
 public:
  // Cells across a face of the cube of directions, and across the square of the normals that face one of them.
  ViewGrid(int views, int normals) : views_(views), normals_(normals) {}

  // A node is a direction to the viewer and one of its normals; both are numbered from 0.
  struct Node {
    std::uint32_t view = 0, normal = 0;
    auto operator<=>(const Node&) const = default;
  };
  // The cell that holds a point: its corner with the lowest numbers, and how far the point is from there along each
  // axis of the cell, 0..1.
  struct Place {
    Node node;
    std::array<float, 4> along = {};
    bool operator==(const Place&) const = default;
  };
  static constexpr std::size_t kCorners = 16;

  // Both vectors are unit and on one side.
  Place place(const Vec3& normal, const Vec3& to_viewer) const;
  // The corners of a cell, and the weight that each of them has at a place within it; the weights sum to 1.
  std::array<Node, kCorners> corners(const Node& cell) const;
  static std::array<float, kCorners> weights(const Place& place);

  struct Facing {
    Vec3 normal, to_viewer;  // unit, on one side
  };
  Facing facing(const Node& node) const;

  std::size_t view_count() const { return 6 * nodes(views_) * nodes(views_); }
  std::size_t normal_count() const { return nodes(normals_) * nodes(normals_); }

 private:
  static std::size_t nodes(int cells) { return static_cast<std::size_t>(cells) + 1; }

  int views_, normals_;
};

}  // namespace goniochrome::render
