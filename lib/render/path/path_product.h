// Light that several paints reflect one after the other.
// goniochrome-color(7), "COLORED LIGHT" and goniochrome-paths(7), "PATHS".
#pragma once

#include <algorithm>
#include <cmath>

#include "color/reflection.h"

namespace goniochrome::render {

// The product of colored light along a path that is followed from the eye: reflect(paint) for each surface in turn,
// then shown(light) = ((light (x) last paint) (x) ... ) (x) first paint. The product of colors is not associative, so
// that paints cannot be multiplied with each other; the matrices R(paint) light = light (x) paint can.
class PathProduct {
 public:
  // `op` null: channel by channel.
  explicit PathProduct(const color::ReflectionOperator* op) : op_(op) {}

  void reflect(const color::Rgb& paint) {
    if (op_ == nullptr) {
      diagonal_ = diagonal_ * paint;
      return;
    }
    const color::Matrix3 next = reflection_matrix(*op_, paint);
    color::Matrix3 result{};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        for (std::size_t k = 0; k < 3; ++k) result[i][j] += matrix_[i][k] * next[k][j];
    matrix_ = result;
  }
  // Reflects off a surface that reflects each channel by itself, whatever the operator.
  void reflect_plain(const color::Rgb& paint) {
    diagonal_ = diagonal_ * paint;
    for (auto& row : matrix_)
      for (std::size_t j = 0; j < 3; ++j) row[j] *= paint[static_cast<int>(j)];
  }
  void scale(double factor) {
    diagonal_ = factor * diagonal_;
    for (auto& row : matrix_)
      for (double& element : row) element *= factor;
  }
  color::Rgb shown(const color::Rgb& light) const {
    return op_ == nullptr ? diagonal_ * light : color::product(matrix_, light);
  }
  // The most that any channel of light of 1 can show: what chance a path has to go on is taken from.
  double size() const {
    if (op_ == nullptr) return std::max({std::abs(diagonal_.x), std::abs(diagonal_.y), std::abs(diagonal_.z)});
    double largest = 0;
    for (const auto& row : matrix_) largest = std::max(largest, std::abs(row[0]) + std::abs(row[1]) + std::abs(row[2]));
    return largest;
  }

 private:
  const color::ReflectionOperator* op_;
  color::Rgb diagonal_{1, 1, 1};
  color::Matrix3 matrix_ = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
};

}  // namespace goniochrome::render
