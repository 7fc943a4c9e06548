// The readers behind read_measured(), one per format, from a file's bytes. Internal to lib/brdf.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "brdf/measured.h"

namespace goniochrome::brdf {

using MeasuredPointer = std::unique_ptr<MeasuredBrdf>;
Result<MeasuredPointer> read_cornell(const std::string& path, std::string_view text);
Result<MeasuredPointer> read_merl(const std::string& path, std::string_view bytes);
Result<MeasuredPointer> read_mbsdf(const std::string& path, std::string_view bytes);
Result<MeasuredPointer> read_rgl(const std::string& path, std::string_view bytes);

bool looks_merl(std::string_view head);
bool looks_mbsdf(std::string_view head);
bool looks_rgl(std::string_view head);

// Little-endian numbers out of bytes, in order; nothing past the end.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : rest_(bytes) {}

  template <class Number>
  std::optional<Number> next() {
    static_assert(std::endian::native == std::endian::little, "these formats are little-endian");
    if (rest_.size() < sizeof(Number)) return std::nullopt;
    Number value;
    std::memcpy(&value, rest_.data(), sizeof value);
    rest_.remove_prefix(sizeof value);
    return value;
  }
  std::optional<std::string_view> text(std::size_t length) {
    if (rest_.size() < length) return std::nullopt;
    const auto result = rest_.substr(0, length);
    rest_.remove_prefix(length);
    return result;
  }
  std::size_t left() const { return rest_.size(); }

 private:
  std::string_view rest_;
};

// Where a coordinate falls between n cells or nodes: the lower one and the weight of the upper; held at the ends.
struct Cell {
  std::size_t low = 0;
  double weight = 0;
};
Cell cell_at(double coordinate, std::size_t n);

// Angle from the normal, radians.
double polar_angle(const Vec3& direction);

// Angle between the azimuths of two directions, 0..pi; 0 where one of them is the normal.
double azimuth_between(const Vec3& a, const Vec3& b);

// Counts `value` into the traits; `negative_square` gathers for negative_rms.
inline void count_sample(double value, MeasuredTraits& traits, double& negative_square) {
  ++traits.samples;
  traits.zero += value == 0;
  if (value < 0) {
    ++traits.negative;
    negative_square += value * value;
  }
}

}  // namespace goniochrome::brdf
