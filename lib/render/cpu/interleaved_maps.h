// Maps as kernels look them up.
#pragma once

namespace goniochrome::render {

// So many points are shaded at a time: their addresses stay in the first cache.
constexpr int kPointsAtOnce = 64;

// Maps that one direction meets, their texels interleaved: for each texel, blocks of two maps, the four forms of the
// product of each (R G B 0 where it is component-wise); or of one map with six forms. A single map of four forms is
// kept in half a block, which halves the memory that the cache has to hold: the other half of a read is the next texel,
// which has no weight.
struct InterleavedMaps {
  int size = 0;          // of a face, without its border of one texel
  int blocks = 0;        // of 8 floats that are read at a texel
  int texel_floats = 0;  // from one texel to the next
  const float* texels = nullptr;
};

}  // namespace goniochrome::render
