// Pictures as a display takes them: 8 bits for each of red, green and blue.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "image/image.h"

namespace goniochrome::image {

// The light that R G B signals stand for: the code points of primaries and curve in ITU-T H.273. 1 and 13 are sRGB.
struct SignalCode {
  int primaries = 1, transfer = 13;
  bool operator==(const SignalCode&) const = default;
};

// R G B by pixels, row 0 at the top.
struct ByteImage {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
  std::optional<SignalCode> signal = SignalCode{};  // none: not known

  std::uint8_t* pixel(int x, int y) { return &rgb[3 * (static_cast<std::size_t>(y) * width + x)]; }
  const std::uint8_t* pixel(int x, int y) const { return &rgb[3 * (static_cast<std::size_t>(y) * width + x)]; }
};

// Values 0..1 as whole numbers 0..255, rounded to the nearest; others are clamped and a NaN is 0. One channel is gray;
// channels after the third are left out.
ByteImage byte_image(const Image& image);
// Converts into `bytes`, whose memory is used again.
void put_bytes(const Image& image, ByteImage& bytes);

// The bytes of a PNG that says which light its signals stand for, with text entries for provenance. Its rows are
// compressed on all cores, and it is the same on any number of them.
std::string png_content(const ByteImage& image, const Attributes& text = {});

// The entry of a PNG that names the display and the view of its picture, "sRGB / ACES SDR"; read_image() keeps it as an
// attribute.
inline constexpr const char* kViewAttribute = "goniochrome:view";

}  // namespace goniochrome::image
