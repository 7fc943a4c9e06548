// A grid over the directions to viewers and, for each of them, over the normals that face it. What changes slowly with
// both is told at its nodes and is linear between them. goniochrome-rendering(7), "Sums".
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "base/vec3.h"

namespace goniochrome::render {

class ViewGrid {
 public:
  // Cells across a face of the cube of directions, and across the square of the normals that face one of them.
  ViewGrid(int views, int normals) : views_(views), normals_(normals) {}
  // The coarsest between whose nodes light, taken as linear, is within a color difference of its sums.
  static ViewGrid within(double tolerance_de00);

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

// Numbers at the nodes of a grid, found when they are first asked for. For any number of threads at once.
class NodeValues {
 public:
  // `count` numbers at each node.
  NodeValues(const ViewGrid& grid, std::size_t count);
  ~NodeValues();
  NodeValues(const NodeValues&) = delete;
  NodeValues& operator=(const NodeValues&) = delete;

  // The numbers of a node. find(node, numbers) writes them if nobody asked before, or others ask at the same time.
  template <class Find>
  const float* at(const ViewGrid::Node& node, const Find& find) const {
    std::atomic<View*>& view = views_[node.view];
    if (view.load() == nullptr) keep(view, std::make_unique<View[]>(grid_.normal_count()));
    View& slot = view.load()[node.normal];
    if (const float* known = slot.load()) return known;
    auto numbers = std::make_unique<float[]>(count_);
    find(node, numbers.get());
    if (keep(slot, std::move(numbers))) ++found_;
    return slot.load();
  }
  // Adds the numbers at a place, which are linear between those of its nodes, to `sum`.
  template <class Find>
  void add(const ViewGrid::Place& place, const Find& find, float* sum) const {
    const auto corners = grid_.corners(place.node);
    const auto weights = ViewGrid::weights(place);
    for (std::size_t c = 0; c < corners.size(); ++c) {
      const float* numbers = at(corners[c], find);
      for (std::size_t k = 0; k < count_; ++k) sum[k] += weights[c] * numbers[k];
    }
  }
  std::size_t found() const { return found_; }  // nodes by now

 private:
  using View = std::atomic<float*>;
  // Keeps what was made unless another thread was first. Returns true if it was kept.
  template <class Value>
  static bool keep(std::atomic<Value*>& slot, std::unique_ptr<Value[]> made) {
    Value* none = nullptr;
    if (!slot.compare_exchange_strong(none, made.get())) return false;
    made.release();
    return true;
  }

  ViewGrid grid_;
  std::size_t count_;
  mutable std::vector<std::atomic<View*>> views_;  // the nodes of their normals; null: none yet
  mutable std::atomic<std::size_t> found_ = 0;
};

}  // namespace goniochrome::render
