// A k-d tree over the colors of paints at several geometries. It lies in flat arrays, which a file can hold and the
// system can map into memory as they are.
// goniochrome-search(7), "NEAREST PAINT".
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace goniochrome::library {

// Paints in a leaf: all leaves but the last are full, so a leaf's place follows from its number.
constexpr std::size_t kLeafSize = 32;

// The range of one channel in both children of a node: [0] left, [1] right.
struct ChildBounds {
  float low[2], high[2];
};

// A tree, wherever its arrays lie. Channels are L a b of the first geometry, L a b of the second, ...
//
// A node that covers m > 1 leaves splits into one over the first m/2 leaves and one over the rest; it holds the boxes
// of both, side by side, since both are asked for at once. Nodes stand in preorder: the left child of node i is node
// i + 1, and the right child is node i + m/2. So no node stores where it points, and a leaf has no node.
struct TreeView {
  std::size_t size = 0;                   // paints
  std::size_t channels = 0;               // 3 for each geometry
  const double* blocks = nullptr;         // leaf by leaf, channel by channel, kLeafSize values; the last leaf is padded
  const ChildBounds* boxes = nullptr;     // node by node, channel by channel: a ChildBounds, rounded outward
  const std::uint32_t* labels = nullptr;  // one a paint, in the order of the blocks: its place in the library

  static std::size_t leaf_count(std::size_t size) { return (size + kLeafSize - 1) / kLeafSize; }
  std::size_t leaves() const { return leaf_count(size); }
  std::size_t nodes() const { return size == 0 ? 0 : leaves() - 1; }
  const double* block(std::size_t leaf) const { return blocks + leaf * channels * kLeafSize; }
  const ChildBounds* children(std::size_t node) const { return boxes + node * channels; }
};

struct Tree {
  std::size_t size = 0, channels = 0;
  std::vector<double> blocks;
  std::vector<ChildBounds> boxes;
  std::vector<std::uint32_t> labels;

  TreeView view() const { return {size, channels, blocks.data(), boxes.data(), labels.data()}; }
};

// The tree over `rows` (one paint after another, `channels` finite numbers each) with one label a row. Every split is
// at the leaf boundary nearest to the median of the channel with the largest variance in a sample; equal values are
// ordered by row, so the tree depends on its input alone.
Tree build_tree(std::span<const double> rows, std::size_t channels, std::span<const std::uint32_t> labels);

}  // namespace goniochrome::library
