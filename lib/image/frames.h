// Pictures one after the other on a stream, as programs for films and viewers read them.
#pragma once

#include <string>

#include "image/byte_image.h"

namespace goniochrome::image {

// kY4m: YUV4MPEG2, brightness and two color differences of every pixel (4:4:4, BT.709, 16 to 235), 25 pictures a
// second. kPpm: PPM pictures of RGB (P6), one behind the other.
enum class FrameFormat { kY4m, kPpm };

// The bytes before the first picture; "" for kPpm.
std::string frames_head(FrameFormat format, int width, int height);

// One picture.
std::string frame_content(FrameFormat format, const ByteImage& image);

}  // namespace goniochrome::image
