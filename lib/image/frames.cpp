#include "image/frames.h"

#include <fmt/core.h>

#include <cmath>

namespace goniochrome::image {

namespace {

// ITU-R BT.709, section 3: Y' from R'G'B', the differences B'-Y' and R'-Y' scaled to -1/2..1/2, and all three as 8
// bits, where brightness has 219 steps from 16 and the differences 224 about 128.
constexpr double kRed = 0.2126, kGreen = 0.7152, kBlue = 0.0722;

std::string planes(const ByteImage& image) {
  const std::size_t pixels = image.rgb.size() / 3;
  std::string planes(3 * pixels, '\0');
  for (std::size_t i = 0; i < pixels; ++i) {
    const double r = image.rgb[3 * i] / 255.0, g = image.rgb[3 * i + 1] / 255.0, b = image.rgb[3 * i + 2] / 255.0;
    const double y = kRed * r + kGreen * g + kBlue * b;
    planes[i] = static_cast<char>(std::lround(16 + 219 * y));
    planes[pixels + i] = static_cast<char>(std::lround(128 + 224 * (b - y) / (2 * (1 - kBlue))));
    planes[2 * pixels + i] = static_cast<char>(std::lround(128 + 224 * (r - y) / (2 * (1 - kRed))));
  }
  return planes;
}

}  // namespace

std::string frames_head(FrameFormat format, int width, int height) {
  if (format == FrameFormat::kPpm) return "";
  return fmt::format("YUV4MPEG2 W{} H{} F25:1 Ip A1:1 C444 XCOLORRANGE=LIMITED\n", width, height);
}

std::string frame_content(FrameFormat format, const ByteImage& image) {
  if (format == FrameFormat::kY4m) return "FRAME\n" + planes(image);
  return fmt::format("P6\n{} {}\n255\n", image.width, image.height) + std::string(image.rgb.begin(), image.rgb.end());
}

}  // namespace goniochrome::image
