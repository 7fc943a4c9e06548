// Maps and the product of colors as kernels read them.
#pragma once

#include <array>
#include <cstddef>

#include "color/reflection.h"
#include "envmap/cube_map.h"

namespace goniochrome::render {

// So many points are shaded at a time: their addresses stay in the first cache.
constexpr int kPointsAtOnce = 64;

// Maps that one direction meets, their texels interleaved: for each texel, blocks of two maps, R G B 0 of each. A
// single map is kept in half a block, which halves the memory that the cache has to hold: the other half of a read is
// the next texel, which has no weight.
struct InterleavedMaps {
  int size = 0;          // of a face, without its border of one texel
  int blocks = 0;        // of 8 floats that are read at a texel
  int texel_floats = 0;  // from one texel to the next
  const float* texels = nullptr;
};

// One map, R G B 0 of each texel.
struct SingleMap {
  int size = 0;
  const float* texels = nullptr;
};

// Texels of six faces with a border of one texel, which has the neighbors of the other faces.
inline std::size_t bordered_texels(int size) {
  return 6 * static_cast<std::size_t>(size + 2) * static_cast<std::size_t>(size + 2);
}
// Writes R G B 0 of each of them, so many floats apart.
void put_bordered(const envmap::CubeMap& map, std::size_t stride, float* to);

// The columns (4 floats) of the matrices by which red, green and blue light multiply, one matrix after the other.
using ProductColumns = std::array<float, 36>;
ProductColumns product_columns(const color::ReflectionOperator& op);

}  // namespace goniochrome::render
