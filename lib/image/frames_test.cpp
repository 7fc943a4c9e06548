#include "image/frames.h"

#include <gtest/gtest.h>

#include <array>

namespace goniochrome::image::frames_test {
namespace {

// The codes of ITU-R BT.709's color bars of 100 %, as SMPTE RP 219 prints them.
TEST(Frames, HaveTheCodesOfTheColorBars) {
  struct Bar {
    std::array<std::uint8_t, 3> rgb;
    std::array<int, 3> ycc;
  };
  const Bar bars[] = {{{255, 255, 255}, {235, 128, 128}}, {{255, 255, 0}, {219, 16, 138}},
                      {{0, 255, 255}, {188, 154, 16}},    {{0, 255, 0}, {173, 42, 26}},
                      {{255, 0, 255}, {78, 214, 230}},    {{255, 0, 0}, {63, 102, 240}},
                      {{0, 0, 255}, {32, 240, 118}},      {{0, 0, 0}, {16, 128, 128}}};
  ByteImage image{8, 1, {}};
  for (const Bar& bar : bars) image.rgb.insert(image.rgb.end(), bar.rgb.begin(), bar.rgb.end());
  const std::string frame = frame_content(FrameFormat::kY4m, image);
  ASSERT_EQ(frame.substr(0, 6), "FRAME\n");
  ASSERT_EQ(frame.size(), 6u + 24u);
  for (std::size_t i = 0; i < 8; ++i)
    for (std::size_t plane = 0; plane < 3; ++plane)
      EXPECT_EQ(static_cast<unsigned char>(frame[6 + 8 * plane + i]), bars[i].ycc[plane]) << i << " " << plane;
}

TEST(Frames, BeginAsTheirFormatSays) {
  EXPECT_EQ(frames_head(FrameFormat::kY4m, 320, 180), "YUV4MPEG2 W320 H180 F25:1 Ip A1:1 C444 XCOLORRANGE=LIMITED\n");
  EXPECT_EQ(frames_head(FrameFormat::kPpm, 320, 180), "");
  EXPECT_EQ(frame_content(FrameFormat::kPpm, {2, 1, {1, 2, 3, 65, 66, 67}}),
            "P6\n2 1\n255\n\x01\x02\x03"
            "ABC");
}

}  // namespace
}  // namespace goniochrome::image::frames_test
