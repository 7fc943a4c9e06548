#include "image/hdr.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <random>

#include "base/scratch_for_test.h"
#include "image/color_space.h"

namespace goniochrome::image::hdr_test {
namespace {

using testing::HasSubstr;

std::string header(int width, int height, const std::string& more = "") {
  return fmt::format("#?RADIANCE\n# by hand\n{}FORMAT=32-bit_rle_rgbe\n\n-Y {} +X {}\n", more, height, width);
}

// Rows as a file holds them, and the bytes of their pixels.
struct Packed {
  std::string bytes;
  std::vector<std::uint8_t> rgbe;
};

// Rows of runs and of plain bytes by turns; exponents over all that there are, 0 with them.
Packed rows_in_runs(int width, int height) {
  std::mt19937 random(5);
  Packed packed;
  for (int y = 0; y < height; ++y) {
    packed.bytes += {2, 2, static_cast<char>(width >> 8), static_cast<char>(width)};
    const std::size_t row = packed.rgbe.size();
    packed.rgbe.resize(row + 4 * static_cast<std::size_t>(width));
    for (std::size_t component = 0; component < 4; ++component)
      for (int done = 0; done < width;) {
        const int count = std::min<int>(width - done, 1 + static_cast<int>(random() % 127));
        const bool run = random() % 2 == 0;
        packed.bytes += static_cast<char>(run ? 128 + count : count);
        for (int i = 0; i < count; ++i) {
          if (i == 0 || !run) packed.bytes += static_cast<char>(random());
          packed.rgbe[row + 4 * static_cast<std::size_t>(done + i) + component] =
              static_cast<std::uint8_t>(packed.bytes.back());
        }
        done += count;
      }
  }
  return packed;
}

Packed plain_pixels(int width, int height) {
  std::mt19937 random(6);
  Packed packed;
  // A mantissa of 2 never comes first, so no row looks like one of runs.
  for (int i = 0; i < 4 * width * height; ++i)
    packed.rgbe.push_back(static_cast<std::uint8_t>(i % 4 == 0 ? 128 + random() % 128 : random()));
  packed.bytes.assign(packed.rgbe.begin(), packed.rgbe.end());
  return packed;
}

class HdrFile : public testing::Test {
 protected:
  Result<ImagePart> read(const std::string& bytes) { return read_image(folder_.file("x.hdr", bytes)); }
  ScratchFolder folder_;
};

// Each pixel is its mantissas times a power of two, worked out here from the bytes that were packed.
TEST_F(HdrFile, PixelsAreMantissasTimesAPowerOfTwo) {
  struct Case {
    int width, height;
    Packed packed;
  };
  for (const Case& c : {Case{8, 3, rows_in_runs(8, 3)}, Case{1000, 7, rows_in_runs(1000, 7)},
                        Case{5, 4, plain_pixels(5, 4)}, Case{40, 4, plain_pixels(40, 4)}}) {
    const auto part = read(header(c.width, c.height) + c.packed.bytes);
    ASSERT_TRUE(part.ok()) << part.error().message;
    EXPECT_EQ(part->image.width, c.width);
    EXPECT_EQ(part->image.height, c.height);
    ASSERT_EQ(part->image.data.size(), c.packed.rgbe.size() / 4 * 3);
    for (std::size_t i = 0; i < part->image.data.size(); ++i) {
      const std::size_t pixel = i / 3 * 4;
      const int exponent = c.packed.rgbe[pixel + 3];
      ASSERT_EQ(part->image.data[i],
                exponent == 0 ? 0 : std::ldexp(static_cast<float>(c.packed.rgbe[pixel + i % 3]), exponent - 136))
          << c.width << " " << i;
    }
    EXPECT_EQ(std::get<std::string>(part->attributes.at("oiio:ColorSpace")), "linear");
    EXPECT_EQ(part->attributes.at("goniochrome:integer"), AttributeValue(0));
  }
}

// Stored rows of a picture of 3 x 2 pixels whose values are 1 2 3 / 4 5 6, for each order that the format has. By the
// order "-Y +X" alone all others were upside down, mirrored or refused.
TEST_F(HdrFile, RowsAndColumnsRunAsTheSizeSays) {
  const std::pair<const char*, const char*> orders[] = {
      {"-Y 2 +X 3", "123456"}, {"-Y 2 -X 3", "321654"}, {"+Y 2 +X 3", "456123"}, {"+Y 2 -X 3", "654321"},
      {"+X 3 -Y 2", "142536"}, {"-X 3 -Y 2", "362514"}, {"+X 3 +Y 2", "415263"}, {"-X 3 +Y 2", "635241"}};
  for (const auto& [size, values] : orders) {
    std::string bytes = fmt::format("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n{}\n", size);
    for (const char* value = values; *value != 0; ++value)
      for (const int byte : {128, 128, 128, 128 + *value - '0'}) bytes += static_cast<char>(byte);
    const auto part = read(bytes);
    ASSERT_TRUE(part.ok()) << part.error().message;
    EXPECT_EQ(part->image.width, 3) << size;
    EXPECT_EQ(part->image.height, 2) << size;
    for (int i = 0; i < 6; ++i)
      EXPECT_EQ(part->image.data[3 * static_cast<std::size_t>(i)], std::ldexp(1.0F, i)) << size << " " << i;
  }
}

// A pixel of 1 1 1 after the lines of a header.
class HdrHeader : public HdrFile {
 protected:
  Result<ImagePart> with(const std::string& lines, const std::string& first = "#?RADIANCE\n") {
    return read(first + lines + "\n-Y 1 +X 1\n\x80\x80\x80\x81");
  }
  std::vector<float> working(const std::string& lines, const std::string& first = "#?RADIANCE\n") {
    auto part = with(lines, first);
    EXPECT_TRUE(part.ok()) << part.error().message;
    return part.ok() ? working_space_rgb(std::move(*part), "x")->data : std::vector<float>();
  }
  const std::string format_ = "FORMAT=32-bit_rle_rgbe\n";
};

TEST_F(HdrHeader, ExposuresAndCorrectionsAreUndone) {
  const auto stored = [&](const std::string& lines) { return with(format_ + lines)->image.data; };
  EXPECT_EQ(stored("COLORCORR=2 1 4\n"), (std::vector<float>{.5F, 1, .25F}));
  EXPECT_EQ(stored("EXPOSURE=2\nrpict -vp 0 0 0\nEXPOSURE= 4.0\n"), (std::vector<float>{.125F, .125F, .125F}));
  EXPECT_EQ(stored(""), (std::vector<float>{1, 1, 1})) << "control";
}

TEST_F(HdrHeader, PrimariesAndWhiteAreKnown) {
  const auto near = [](const std::vector<float>& rgb) {
    return testing::Pointwise(testing::FloatNear(1e-4F), std::vector<float>(rgb));
  };
  EXPECT_THAT(working(format_), near({1, 1, 1}));
  // Red of Rec.2020 is red of the working space. Without the line it is red of Rec.709.
  const std::string rec2020 = "PRIMARIES=0.708 0.292 0.170 0.797 0.131 0.046 0.3127 0.3290\n";
  const auto of_red = [&](const std::string& lines) {
    auto part = read("#?RADIANCE\n" + format_ + lines + "\n-Y 1 +X 1\n" + std::string("\x80\0\0\x81", 4));
    return working_space_rgb(std::move(*part), "x")->data;
  };
  EXPECT_THAT(of_red(rec2020), near({1, 0, 0}));
  EXPECT_NEAR(of_red("")[0], .6274, 1e-3) << "control";
  EXPECT_NEAR(of_red("PRIMARIES=0 0 0 0 0 0 0 0\n")[0], .6274, 1e-3) << "primaries that a writer did not know";
  // Even X, Y and Z are the white of such files; X alone lies outside of all colors.
  EXPECT_THAT(working("FORMAT=32-bit_rle_xyze\n"), near({1, 1, 1}));
}

TEST_F(HdrHeader, NeedsNoMarkAtItsBegin) {
  EXPECT_EQ(with(format_, "")->image.data, (std::vector<float>{1, 1, 1}));
  EXPECT_EQ(with(format_, "rpict -x 1\n")->image.data, (std::vector<float>{1, 1, 1}));
  EXPECT_EQ(with("", "#?RGBE\n")->image.data, (std::vector<float>{1, 1, 1}));
}

TEST_F(HdrHeader, LinesThatAreNotUnderstoodAreNamed) {
  const auto problem = [&](const std::string& lines) { return with(lines).error().message; };
  EXPECT_THAT(problem("FORMAT=radiance_octree\n"), HasSubstr("x.hdr:2: \"FORMAT=radiance_octree\""));
  EXPECT_THAT(problem(format_ + "EXPOSURE=0\n"), HasSubstr(":3: \"EXPOSURE=0\": write one number above 0"));
  EXPECT_THAT(problem(format_ + "COLORCORR=1 1\n"), HasSubstr("write three numbers above 0"));
  EXPECT_THAT(problem(format_ + "PRIMARIES=1 2 3\n"), HasSubstr("write x and y of red, green, blue and white"));
  EXPECT_THAT(problem(format_ + "EXPOSURE=1e-300\n"), HasSubstr("too large for a float"));
  EXPECT_THAT(read("#?RADIANCE\n\n-Y 1\n").error().message, HasSubstr("is to tell the size"));
  EXPECT_THAT(read("#?RADIANCE\n").error().message, HasSubstr("its header does not end"));
}

TEST_F(HdrFile, RunsOfTheFirstYearsRepeatAPixel) {
  const auto row = [](int width, const std::string& pixels) { return header(width, 1) + pixels; };
  const std::string pixel = "\x80\x80\x80\x81", twice("\x01\x01\x01\x02", 4), once("\x01\x01\x01\x01", 4);
  EXPECT_EQ(read(row(3, pixel + twice))->image.data, std::vector<float>(9, 1));
  EXPECT_EQ(read(row(259, pixel + twice + once))->image.data, std::vector<float>(777, 1)) << "2 + 256";
  EXPECT_THAT(read(row(2, pixel + twice)).error().message, HasSubstr("row 0"));
  EXPECT_THAT(read(row(3, twice + pixel)).error().message, HasSubstr("row 0")) << "there is nothing to repeat";
}

TEST_F(HdrFile, ADamagedFileIsRefusedByRow) {
  const std::string whole = header(200, 6) + rows_in_runs(200, 6).bytes;
  const auto cut = decoded_hdr(whole.substr(0, whole.size() - 1), "sky.hdr");
  ASSERT_FALSE(cut.ok());
  EXPECT_THAT(cut.error().message, HasSubstr("sky.hdr: row 5 is cut short or damaged"));
  std::string overrun = whole;
  overrun[header(200, 6).size() + 4] = static_cast<char>(0);  // a run of nothing
  EXPECT_THAT(decoded_hdr(overrun, "sky.hdr").error().message, HasSubstr("row 0"));
  // A size that the bytes cannot stand for asks for no memory.
  const auto forged = decoded_hdr(header(30000, 20000) + rows_in_runs(200, 6).bytes, "sky.hdr");
  ASSERT_FALSE(forged.ok());
  EXPECT_THAT(forged.error().message, HasSubstr("sky.hdr: is cut short: its header says 30000 x 20000 pixels"));
}

TEST_F(HdrFile, DamageNeverCrashes) {
  const std::string whole = header(64, 4) + rows_in_runs(64, 4).bytes;
  std::mt19937 random(3);
  int refused = 0, read = 0;
  for (int i = 0; i < 3000; ++i) {
    std::string hurt = whole.substr(0, i % 2 == 0 ? whole.size() : random() % whole.size());
    for (int k = 0; k < 2 && !hurt.empty(); ++k) hurt[random() % hurt.size()] = static_cast<char>(random());
    const auto part = decoded_hdr(hurt, "x");
    refused += !part.ok();
    read += part.ok();
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
}  // namespace goniochrome::image::hdr_test
