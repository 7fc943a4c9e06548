// The formats that read_measured() knows, and what their readers share. A format is a measured_NAME.cpp that defines
// its entry of the table below.
#pragma once

#include <algorithm>
#include <array>
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

struct MeasuredFormat {
  // True if a file of this name that begins with `head` (200 bytes are enough) is of this format.
  bool (*recognizes)(std::string_view path, std::string_view head);
  Result<MeasuredPointer> (*read)(const std::string& path, std::string_view bytes);
  const char* name;  // for people, with the ending of its files
};
extern const MeasuredFormat kMerl, kMbsdf, kRgl, kOpenMaterial, kCornell;

// The first that recognizes a file reads it. Cornell's text has no mark but the name of its file, so it comes last, and
// is tried where no format recognizes the file.
inline constexpr std::array<const MeasuredFormat*, 5> kMeasuredFormats = {&kMerl, &kMbsdf, &kRgl, &kOpenMaterial,
                                                                          &kCornell};

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

// True where RGB below 0 is noise: it lies outside the working space too, by more than a table's own rounding.
inline bool is_noise(const color::Rgb& rec709) {
  constexpr double kRounding = 0.005;  // of the largest channel
  const color::Rgb working = color::rec2020_from_rec709(rec709);
  const double largest = std::max({std::abs(rec709.x), std::abs(rec709.y), std::abs(rec709.z)});
  return std::min({working.x, working.y, working.z}) < -kRounding * largest;
}

}  // namespace goniochrome::brdf
