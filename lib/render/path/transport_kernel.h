// The kernel that shades points of a transport. It is compiled for several instruction sets, of which the best that the
// processor has is chosen at run time.
#pragma once

#include <cstddef>
#include <cstdint>

namespace goniochrome::render {

// Points that lie side by side: their light is kept as [column][channel][point], in halves.
constexpr std::size_t kTransportLanes = 16;

struct TransportBlock {
  const std::uint16_t* direct = nullptr;
  const std::uint16_t* bounced = nullptr;  // null: none
  const std::uint16_t* classes = nullptr;  // [class][channel][point]
};

struct TransportWeights {
  std::size_t columns = 0, classes = 0;
  const float* matrices = nullptr;     // [column][output channel][light channel]
  const std::uint8_t* dark = nullptr;  // of each column: it adds nothing
  const float* factors = nullptr;      // [class][channel]
};

// rgb: [channel][point].
void shade_transport(const TransportBlock& block, const TransportWeights& weights, float* rgb);

}  // namespace goniochrome::render
