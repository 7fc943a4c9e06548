// Where a pixel stands among the points of a transport.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "render/light_transport.h"

namespace goniochrome::sketch {

// Nothing outside the picture, and where no surface was traced.
inline std::optional<std::size_t> point_at(const render::LobeTransport& transport, int x, int y) {
  if (x < 0 || y < 0 || x >= transport.width || y >= transport.height) return std::nullopt;
  const auto place =
      static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(transport.width) + static_cast<std::uint32_t>(x);
  const auto found = std::ranges::lower_bound(transport.places, place);
  if (found == transport.places.end() || *found != place) return std::nullopt;
  return static_cast<std::size_t>(found - transport.places.begin());
}

}  // namespace goniochrome::sketch
