// The bilinear product of two colors is written as a few plain products of numbers, so that a sum over many maps costs
// as much as with the component-wise product. goniochrome-color(7), "Forms".
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "color/reflection.h"

namespace goniochrome::render {

// A (x) B = out ((in A) * (in B)), where * takes each of the `count` forms by itself. White goes back: A = out ((in A)
// * (in white)).
struct ProductForms {
  int count = 3;
  std::array<Vec3, 6> in = {Vec3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  std::array<Vec3, 6> out = in;  // columns

  double of(int form, const color::Rgb& a) const { return dot(in[static_cast<std::size_t>(form)], a); }
};

// Three forms for the component-wise product, four for nearly every other operator, six for one that four would not
// make within single precision.
ProductForms product_forms(const color::ReflectionOperator& op);

// The four forms of `count` colors that lie `step` floats apart, one color behind the other.
std::vector<float> in_four_forms(const ProductForms& forms, const float* colors, std::size_t count, std::size_t step);

}  // namespace goniochrome::render
