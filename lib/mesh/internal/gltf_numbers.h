// Numbers of glTF files by their component types (glTF 2.0, sections 3.6.2.2 and 5.1.3).
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace goniochrome::mesh {

enum GltfComponent { kByte = 5120, kUnsignedByte, kShort, kUnsignedShort, kUnsignedInt = 5125, kFloat };

// A number of the component type, and as a share of its largest value where it is normalized.
inline double number_at(const char* bytes, int component, bool normalized) {
  const auto read = [&](auto value, double most) {
    std::memcpy(&value, bytes, sizeof value);
    return normalized ? std::max(-1.0, static_cast<double>(value) / most) : static_cast<double>(value);
  };
  switch (component) {
    case kByte:
      return read(std::int8_t{}, 127);
    case kUnsignedByte:
      return read(std::uint8_t{}, 255);
    case kShort:
      return read(std::int16_t{}, 32767);
    case kUnsignedShort:
      return read(std::uint16_t{}, 65535);
    case kUnsignedInt:
      return read(std::uint32_t{}, 4294967295.0);
    default:
      return read(float{}, 1);
  }
}

// The bytes of one number of that type; 0 where no mesh has such numbers.
inline std::size_t bytes_of_number(int component) {
  switch (component) {
    case kByte:
    case kUnsignedByte:
      return 1;
    case kShort:
    case kUnsignedShort:
      return 2;
    case kUnsignedInt:
    case kFloat:
      return 4;
    default:
      return 0;
  }
}

inline bool is_index(int component) {
  return component == kUnsignedByte || component == kUnsignedShort || component == kUnsignedInt;
}

}  // namespace goniochrome::mesh
