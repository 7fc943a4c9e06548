// The numbers of a page: all in one binary text. JSON names each list by its place.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/json.h"

namespace goniochrome::studio {

class PackedNumbers {
 public:
  // Takes a list and returns its place: its first byte, a multiple of 8, and how many numbers it has. Numbers are
  // little-endian.
  template <class Number>
  Json add(const std::vector<Number>& numbers) {
    return add_bytes({reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number)}, numbers.size());
  }
  // Adds the texels of a smooth map of so many channels. Each number is replaced by its difference from that of the
  // texel before, and all low bytes go before all high bytes, so that the map compresses well.
  Json add_smooth(const std::vector<std::uint16_t>& numbers, std::size_t channels = 3);

  const std::string& bytes() const { return bytes_; }

 private:
  Json add_bytes(std::string_view bytes, std::size_t count);

  std::string bytes_;
};

}  // namespace goniochrome::studio
