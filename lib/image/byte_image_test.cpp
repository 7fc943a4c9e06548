#include "image/byte_image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <limits>
#include <random>

#include "base/file.h"
#include "base/parallel.h"
#include "base/scratch_for_test.h"
#include "image/color_space.h"

namespace goniochrome::image::byte_image_test {
namespace {

using testing::HasSubstr;
using testing::Not;

// Half of it smooth and half of it noise, so that runs and literal bytes are both stored.
ByteImage drawn(int width, int height) {
  std::mt19937 random(3);
  ByteImage image{width, height, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c)
        image.rgb.push_back(static_cast<std::uint8_t>(x < width / 2 ? (x * 3 + y * c) / 7 : random()));
  return image;
}

// libpng, is the judge of what was written: one band, several bands, and rows longer than a band.
TEST(Png, ReadsBackBitForBitByAnotherProgram) {
  const ScratchFolder folder;
  for (const auto& [width, height] : {std::pair{1, 1}, {37, 21}, {640, 480}, {100000, 3}}) {
    const ByteImage image = drawn(width, height);
    ASSERT_TRUE(write_file(folder.path("x.png"), png_content(image)).ok());
    const auto read = read_image(folder.path("x.png"));
    ASSERT_TRUE(read.ok()) << read.error().message;
    ASSERT_EQ(read->image.width, width);
    ASSERT_EQ(read->image.height, height);
    EXPECT_EQ(byte_image(read->image).rgb, image.rgb) << width << " x " << height;
  }
}

TEST(Png, IsTheSameOnAnyNumberOfThreads) {
  const ByteImage image = drawn(900, 700);
  set_threads(1);
  const std::string one = png_content(image);
  set_threads(5);
  EXPECT_EQ(png_content(image), one);
  set_threads(0);
}

TEST(Png, HoldsTextInAsciiAndBeyond) {
  const std::string file =
      png_content(drawn(2, 2), {{"Software", std::string("goniochrome")}, {"paint", std::string("caf\xC3\xA9")}});
  EXPECT_THAT(file, HasSubstr(std::string("tEXtSoftware\0goniochrome", 24)));
  EXPECT_THAT(file, HasSubstr(std::string("iTXtpaint\0\0\0\0\0caf\xC3\xA9", 19)));
}

// Without a chunk of its own a PNG left it to each program to guess its light.
TEST(Png, SaysWhichLightItsSignalsStandFor) {
  ByteImage image = drawn(2, 2);
  EXPECT_THAT(png_content(image), HasSubstr(std::string("\0\0\0\1sRGB\1", 9)));
  image.signal = SignalCode{9, 16};
  EXPECT_THAT(png_content(image), HasSubstr(std::string("\0\0\0\4cICP\x09\x10\0\1", 12)));
  EXPECT_THAT(png_content(image), Not(HasSubstr("sRGB")));
  image.signal.reset();
  EXPECT_THAT(png_content(image), Not(HasSubstr("cICP")));
}

// Red of Display P3 was read as red of sRGB, as was any other than that.
TEST(Png, ReadsBackTheLightOfItsSignals) {
  const ScratchFolder folder;
  const auto red_in = [&](const std::string& file) {
    auto part = read_image(folder.file("x.png", file));
    EXPECT_TRUE(part.ok()) << part.error().message;
    return working_space_rgb(std::move(*part), "x.png");
  };
  ByteImage red{1, 1, {255, 0, 0}};
  EXPECT_NEAR(red_in(png_content(red))->data[0], .6274, 1e-3);
  red.signal = SignalCode{12, 13};
  EXPECT_NEAR(red_in(png_content(red))->data[0], .7538, 1e-3);
  red.signal = SignalCode{9, 16};
  EXPECT_THAT(red_in(png_content(red)).error().message, HasSubstr("its color space is \"cICP 9 16 0 1\""));
  // The primaries in units of 1e-5, white first.
  red.signal.reset();
  std::string file = png_content(red), chunk = "cHRM";
  for (const std::uint32_t number : {31270, 32900, 68000, 32000, 26500, 69000, 15000, 6000})
    for (const int shift : {24, 16, 8, 0}) chunk += static_cast<char>(number >> shift & 0xFF);
  const uLong check = crc32(0, reinterpret_cast<const Bytef*>(chunk.data()), static_cast<uInt>(chunk.size()));
  std::string tail;
  for (const int shift : {24, 16, 8, 0}) tail += static_cast<char>(check >> shift & 0xFF);
  constexpr std::size_t kBehindHeader = 8 + 25;
  file.insert(kBehindHeader, std::string("\0\0\0\x20", 4) + chunk + tail);
  EXPECT_NEAR(red_in(file)->data[0], .7538, 1e-3);
}

TEST(Png, AValueThatIsNotFiniteIsRefusedByPixel) {
  Image image{2, 1, 3, {0, 0, 0, 0, 1, 0}, {}};
  EXPECT_TRUE(png_content("x.png", image).ok());
  image.data[4] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(png_content("x.png", image).error().message, HasSubstr("x.png: pixel 1,0 channel G is nan: only finite"));
  EXPECT_THAT(write_png("no/x.png", image).error().message, HasSubstr("is nan"));
}

TEST(ByteImage, RoundsToTheNearestAndClamps) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const Image image{2, 1, 4, {0.5F / 255 - 1e-6F, 0.5F / 255 + 1e-6F, 2, 9, -1, nan, 1, 9}, {}};
  EXPECT_EQ(byte_image(image).rgb, (std::vector<std::uint8_t>{0, 1, 255, 0, 0, 255}));
  const Image gray{2, 1, 1, {1, 0.2F}, {}};
  EXPECT_EQ(byte_image(gray).rgb, (std::vector<std::uint8_t>{255, 255, 255, 51, 51, 51}));
}

}  // namespace
}  // namespace goniochrome::image::byte_image_test
