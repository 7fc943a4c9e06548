#include "image/hdr.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "base/scratch_for_test.h"

namespace goniochrome::image {
namespace {

using testing::HasSubstr;

std::string header(int width, int height, const std::string& more = "") {
  return fmt::format("#?RADIANCE\n# by hand\n{}FORMAT=32-bit_rle_rgbe\n\n-Y {} +X {}\n", more, height, width);
}

// Rows of runs and of plain bytes by turns; exponents over all that there are, 0 with them.
std::string rows_in_runs(int width, int height) {
  std::mt19937 random(5);
  std::string bytes;
  for (int y = 0; y < height; ++y) {
    bytes += {2, 2, static_cast<char>(width >> 8), static_cast<char>(width)};
    for (int component = 0; component < 4; ++component)
      for (int done = 0; done < width;) {
        const int count = std::min<int>(width - done, 1 + static_cast<int>(random() % 127));
        const bool run = random() % 2 == 0;
        bytes += static_cast<char>(run ? 128 + count : count);
        for (int i = 0; i < (run ? 1 : count); ++i) bytes += static_cast<char>(random());
        done += count;
      }
  }
  return bytes;
}

std::string plain_pixels(int width, int height) {
  std::mt19937 random(6);
  std::string bytes;
  // A mantissa of 2 never comes first, so no row looks like one of runs.
  for (int i = 0; i < 4 * width * height; ++i) bytes += static_cast<char>(i % 4 == 0 ? 128 + random() % 128 : random());
  return bytes;
}

class HdrFile : public testing::Test {
 protected:
  Result<ImagePart> read(const std::string& bytes) { return read_image(folder_.file("x.hdr", bytes)); }
  ScratchFolder folder_;
};

// OpenImageIO is the judge: with a gamma other than 1 the same pixels go through it. Its powers of two are a step of a
// float low for some exponents.
TEST_F(HdrFile, PixelsAreThoseThatOpenImageIOReads) {
  constexpr double kStep = 1.2e-7;
  struct Case {
    int width, height;
    std::string pixels;
  };
  for (const Case& c : {Case{8, 3, rows_in_runs(8, 3)}, Case{1000, 7, rows_in_runs(1000, 7)},
                        Case{5, 4, plain_pixels(5, 4)}, Case{40, 4, plain_pixels(40, 4)}}) {
    const auto own = read(header(c.width, c.height) + c.pixels);
    const auto judge = read(header(c.width, c.height, "GAMMA=2\n") + c.pixels);
    ASSERT_TRUE(own.ok()) << own.error().message;
    ASSERT_TRUE(judge.ok()) << judge.error().message;
    EXPECT_EQ(own->image.width, c.width);
    EXPECT_EQ(own->image.height, c.height);
    ASSERT_EQ(own->image.data.size(), judge->image.data.size());
    for (std::size_t i = 0; i < own->image.data.size(); ++i)
      ASSERT_NEAR(own->image.data[i], judge->image.data[i], kStep * judge->image.data[i]) << c.width << " " << i;
    EXPECT_EQ(std::get<std::string>(own->attributes.at("oiio:ColorSpace")), "linear");
    EXPECT_EQ(own->attributes.at("goniochrome:integer"), judge->attributes.at("goniochrome:integer"));
  }
}

TEST_F(HdrFile, OtherKindsAreLeftToOpenImageIO) {
  const std::string pixels = plain_pixels(2, 1), common = header(2, 1);
  const auto other = [&](const std::string& from, const std::string& to) {
    std::string changed = common;
    return changed.replace(changed.find(from), from.size(), to) + pixels;
  };
  ASSERT_TRUE(decoded_hdr(common + pixels, "x").value());
  EXPECT_FALSE(decoded_hdr(other("-Y", "+Y"), "x").value());
  EXPECT_FALSE(decoded_hdr(other("rgbe", "xyze"), "x").value());
  EXPECT_FALSE(decoded_hdr(other("# by hand", "GAMMA=1.8"), "x").value());
  EXPECT_TRUE(decoded_hdr(other("# by hand", "GAMMA=1"), "x").value());
  EXPECT_FALSE(decoded_hdr("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 8", "x").value());
}

TEST_F(HdrFile, ADamagedFileIsRefusedByRow) {
  const std::string whole = header(200, 6) + rows_in_runs(200, 6);
  const auto cut = decoded_hdr(whole.substr(0, whole.size() - 1), "sky.hdr");
  ASSERT_FALSE(cut.ok());
  EXPECT_THAT(cut.error().message, HasSubstr("sky.hdr: row 5 is cut short or damaged"));
  std::string overrun = whole;
  overrun[header(200, 6).size() + 4] = static_cast<char>(0);  // a run of nothing
  EXPECT_THAT(decoded_hdr(overrun, "sky.hdr").error().message, HasSubstr("row 0"));
  const std::string repeated = header(2, 1) + "\x80\x80\x80\x81\x01\x01\x01\x01";
  EXPECT_THAT(decoded_hdr(repeated, "sky.hdr").error().message, HasSubstr("row 0"));
  // A size that the bytes cannot stand for asks for no memory.
  const auto forged = decoded_hdr(header(30000, 20000) + rows_in_runs(200, 6), "sky.hdr");
  ASSERT_FALSE(forged.ok());
  EXPECT_THAT(forged.error().message, HasSubstr("sky.hdr: is cut short: its header says 30000 x 20000 pixels"));
}

TEST_F(HdrFile, DamageNeverCrashes) {
  const std::string whole = header(64, 4) + rows_in_runs(64, 4);
  std::mt19937 random(3);
  int refused = 0, read = 0;
  for (int i = 0; i < 3000; ++i) {
    std::string hurt = whole.substr(0, i % 2 == 0 ? whole.size() : random() % whole.size());
    for (int k = 0; k < 2 && !hurt.empty(); ++k) hurt[random() % hurt.size()] = static_cast<char>(random());
    const auto part = decoded_hdr(hurt, "x");
    refused += !part.ok();
    read += part.ok() && part->has_value();
  }
  EXPECT_GT(refused, 100);
  EXPECT_GT(read, 100);
}

TEST_F(HdrFile, AGrayPixelIsItsRadiance) {
  const auto gray = read(header(1, 1) + std::string("\x80\x80\x80\x81", 4));
  ASSERT_TRUE(gray.ok());
  EXPECT_EQ(gray->image.data, (std::vector<float>{1, 1, 1}));
}

}  // namespace
}  // namespace goniochrome::image
