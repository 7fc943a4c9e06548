#include "image/byte_image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "base/file.h"
#include "base/parallel.h"
#include "base/scratch_for_test.h"

namespace goniochrome::image {
namespace {

using testing::HasSubstr;

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

TEST(ByteImage, RoundsToTheNearestAndClamps) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const Image image{2, 1, 4, {0.5F / 255 - 1e-6F, 0.5F / 255 + 1e-6F, 2, 9, -1, nan, 1, 9}, {}};
  EXPECT_EQ(byte_image(image).rgb, (std::vector<std::uint8_t>{0, 1, 255, 0, 0, 255}));
  const Image gray{2, 1, 1, {1, 0.2F}, {}};
  EXPECT_EQ(byte_image(gray).rgb, (std::vector<std::uint8_t>{255, 255, 255, 51, 51, 51}));
}

}  // namespace
}  // namespace goniochrome::image
