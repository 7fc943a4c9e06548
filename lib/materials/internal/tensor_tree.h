// A tensor tree of rank 3, as Radiance's files of isotropic reflection hold it: an octree over the sine of the
// incidence and over the disc of the directions that light leaves in, mapped to a square [ShirleyChiu1997]. Each leaf
// has one color, and nothing is interpolated. goniochrome-export(7), "Radiance".
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/vec3.h"
#include "color/color.h"

namespace goniochrome::materials {

class TensorTree {
 public:
  // XYZ of f in 1/sr, relative to the illuminant E, for unit directions in the frame whose z is the normal. It is the
  // same on both sides of the plane of incidence.
  using Reflection = std::function<color::Xyz(const Vec3& to_light, const Vec3& to_viewer)>;

  // Cells in which the color changes by less than what an eye sees are one leaf. Others are halved, down to 1/256 of
  // the square; there they have the mean of their color.
  explicit TensorTree(const Reflection& f);

  // The leaf at two directions, as Radiance looks it up.
  color::Xyz at(const Vec3& to_light, const Vec3& to_viewer) const;

  // The tree of one channel in the words of the file: 0 is Y, 1 is CIE u', 2 is v'.
  std::string text(int channel) const;

 private:
  struct Node {
    std::array<float, 3> value{};  // Y, u', v'
    std::int32_t child = -1;       // the first of eight; -1 for a leaf
    bool even_hue = false;         // where the trees of u' and v' have a leaf, which is that of Y or above it
  };
  struct Range;
  Range grow(const Reflection& f, const std::array<int, 3>& cell, int depth, std::vector<Node>& nodes,
             std::size_t at) const;
  bool ends(std::size_t node, int channel) const;
  void append(std::string& text, std::size_t node, int channel, bool mirrored) const;

  std::vector<Node> nodes_;
};

}  // namespace goniochrome::materials
