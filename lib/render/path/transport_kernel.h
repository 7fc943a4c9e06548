// The kernel that shades points of a transport. It is compiled for several instruction sets, of which the best that the
// processor has is chosen at run time.
#pragma once

#include <cstddef>
#include <cstdint>

namespace goniochrome::render {

// Points that lie side by side: their light is kept as [point][channel] for each column and each class.
struct TransportPoints {
  std::size_t count = 0;
  const float* const* direct = nullptr;   // by column
  const float* const* bounced = nullptr;  // by column; null: none
  const float* const* classes = nullptr;
};

struct TransportWeights {
  std::size_t columns = 0, classes = 0;
  const float* matrices = nullptr;     // [column][output channel][light channel]
  const std::uint8_t* dark = nullptr;  // of each column: it adds nothing
  const float* factors = nullptr;      // of bounced light: [class][channel]; [channel] without classes
};

// rgb: [point][channel].
void shade_transport(const TransportPoints& points, const TransportWeights& weights, float* rgb);

}  // namespace goniochrome::render
