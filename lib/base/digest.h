// A digest of data by which files of a cache are known.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "base/text.h"

namespace goniochrome {

// 128 bits that stand for a stream of words: two multiplicative hashes with different odd factors. They tell data apart
// that differ by accident, not data that somebody made alike on purpose.
class Digest {
 public:
  void add(std::uint64_t word) {
    a_ = (std::rotl(a_, 23) ^ word) * 0x9e3779b97f4a7c15U;
    b_ = (std::rotl(b_, 41) ^ word) * 0xc2b2ae3d27d4eb4fU;
  }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
  // Eight bytes a word, the last one filled up with zeros, after their number.
  void add(std::string_view bytes) {
    add(static_cast<std::uint64_t>(bytes.size()));
    for (std::size_t i = 0; i < bytes.size(); i += sizeof(std::uint64_t)) {
      std::uint64_t word = 0;
      std::memcpy(&word, bytes.data() + i, std::min(sizeof word, bytes.size() - i));
      add(word);
    }
  }
  void add(const std::vector<float>& values) {
    add(std::string_view(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)));
  }
  std::string hex() const { return fmt::format("{:016x}{:016x}", a_ ^ (a_ >> 29), b_ ^ (b_ >> 29)); }

 private:
  std::uint64_t a_ = 0x243f6a8885a308d3U, b_ = 0x13198a2e03707344U;
};

}  // namespace goniochrome
