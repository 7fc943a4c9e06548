// PNG files of kinds that this project does not write, and PNM.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cstdint>

#include "base/scratch_for_test.h"
#include "image/image.h"

namespace goniochrome::image::png_test {
namespace {

using std::string_literals::operator""s;
using testing::ElementsAre;
using testing::FloatNear;
using testing::HasSubstr;
using testing::Pointwise;

std::string big_endian(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift);
  return bytes;
}

std::string chunk(const std::string& type, const std::string& data) {
  const std::string both = type + data;
  const uLong check = crc32(0, reinterpret_cast<const Bytef*>(both.data()), static_cast<uInt>(both.size()));
  return big_endian(static_cast<std::uint32_t>(data.size())) + both + big_endian(static_cast<std::uint32_t>(check));
}

// `rows` are the filtered rows; `more` are the chunks between the header and the pixels.
std::string png(int width, int height, char bits, char color_type, const std::string& rows, const std::string& more) {
  std::string packed(compressBound(rows.size()), '\0');
  uLongf size = packed.size();
  compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(rows.data()), rows.size());
  packed.resize(size);
  return "\x89PNG\r\n\x1a\n" +
         chunk("IHDR", big_endian(static_cast<std::uint32_t>(width)) + big_endian(static_cast<std::uint32_t>(height)) +
                           std::string{bits, color_type, 0, 0, 0}) +
         more + chunk("IDAT", packed) + chunk("IEND", "");
}

constexpr char kGray = 0, kPalette = 3, kGrayAlpha = 4;

class PngFile : public testing::Test {
 protected:
  Result<ImagePart> read(const std::string& bytes) { return read_image(folder_.file("x.png", bytes)); }
  ScratchFolder folder_;
};

TEST_F(PngFile, APaletteBecomesItsColorsTimesTheirAlpha) {
  // Two bits for each of four pixels, which count 0 to 3.
  const auto part = read(png(4, 1, 2, kPalette, "\0\x1b"s,
                             chunk("PLTE", "\xff\0\0\0\xff\0\0\0\xff\xff\xff\xff"s) + chunk("tRNS", "\xff\x33\0"s)));
  ASSERT_TRUE(part.ok()) << part.error().message;
  EXPECT_THAT(part->image.channel_names, ElementsAre("R", "G", "B", "A"));
  const std::vector<float> wanted = {1, 0, 0, 1, 0, .2F, 0, .2F, 0, 0, 0, 0, 1, 1, 1, 1};
  EXPECT_THAT(part->image.data, Pointwise(FloatNear(1e-6F), wanted));
}

TEST_F(PngFile, FewBitsAndManyAreShares) {
  const auto bits = read(png(4, 1, 1, kGray, "\0\xa0"s, ""));
  ASSERT_TRUE(bits.ok()) << bits.error().message;
  EXPECT_THAT(bits->image.data, ElementsAre(1, 0, 1, 0));
  const auto deep = read(png(1, 1, 16, kGrayAlpha, "\0\x33\x33\x80\x00"s, ""));
  ASSERT_TRUE(deep.ok()) << deep.error().message;
  EXPECT_THAT(deep->image.channel_names, ElementsAre("Y", "A"));
  EXPECT_NEAR(deep->image.data[0], .2 * 32768 / 65535, 1e-6);
}

TEST_F(PngFile, TellsItsColorSpace) {
  const auto space = [&](const std::string& more) {
    const auto part = read(png(1, 1, 8, kGray, "\0\x80"s, more));
    return part.ok() ? text_attribute(*part, "oiio:ColorSpace") + text_attribute(*part, "colorInteropID")
                     : part.error().message;
  };
  EXPECT_EQ(space(""), "sRGB");
  EXPECT_EQ(space(chunk("gAMA", big_endian(100000))), "linear");
  EXPECT_EQ(space(chunk("gAMA", big_endian(55556))), "Gamma1.8");
  EXPECT_EQ(space(chunk("gAMA", big_endian(55556)) + chunk("sRGB", "\0"s)), "sRGB");
  EXPECT_EQ(space(chunk("tEXt", "colorInteropID\0lin_ap1_scene"s)), "sRGBlin_ap1_scene");
}

TEST_F(PngFile, ACutFileIsAnErrorWhereverItEnds) {
  const std::string whole = png(4, 1, 1, kGray, "\0\xa0"s, "");
  for (std::size_t size = 8; size < whole.size(); ++size) {
    const auto part = read(whole.substr(0, size));
    ASSERT_FALSE(part.ok()) << size;
    EXPECT_THAT(part.error().message, HasSubstr("x.png: cannot be read as an image: the file is cut short"));
  }
}

// Gray and color in every kind that holds them.
TEST_F(PngFile, PnmIsReadInEveryKind) {
  const std::vector<float> gray = {1, 0, 0, 1}, rgb = {1, 0, 0, 0, 1, .2F};
  const std::string one = "\0\0\x80\x3f"s, none = std::string(4, '\0');
  for (const auto& [content, wanted] : std::vector<std::pair<std::string, std::vector<float>>>{
           {"P1 2 2 01\n1 0", gray},
           {"P2\n# a comment\n2 2 9\n9 0 0 9", gray},
           {"P3 2 1 10 10 0 0 0 10 2", rgb},
           {"P4 2 2\n\x40\x80", gray},
           {"P5 2 2 255\n\xff\0\0\xff"s, gray},
           {"P5 2 2 1000\n\x03\xe8\0\0\0\0\x03\xe8"s, gray},
           {"P6 2 1 255\n\xff\0\0\0\xff\x33"s, rgb},
           {"Pf 2 2 -1\n" + none + one + one + none, gray},
           {"PF 1 1 -2\n" + one + none + one, {2, 0, 2}},
           {"Pf 1 1 1\n\x3f\x80\0\0"s, {1}},
           // Lines that end as Windows ends them moved the bytes by one, so that red was green.
           {"P6\r\n2 1\r\n255\r\n\xff\0\0\0\xff\x33"s, rgb},
           {"Pf\r\n2 2\r\n-1\r\n" + none + one + one + none, gray},
           {"P5\r2 1\r255\r\n\xff"s, {10 / 255.0F, 1}}}) {
    const auto part = read_image(folder_.file("x.pnm", content));
    ASSERT_TRUE(part.ok()) << part.error().message;
    EXPECT_THAT(part->image.data, Pointwise(FloatNear(1e-6F), wanted)) << content;
    const bool floats = content[1] == 'f' || content[1] == 'F';
    EXPECT_EQ(text_attribute(*part, "oiio:ColorSpace"), floats ? "linear" : "Rec709");
  }
  // Values above white, which the order of bytes may cause, were taken as white.
  for (const std::string& above : {"P5 2 1 1000\n\xe8\x03\0\0"s, "P5 2 1 100\n\x65\0"s}) {
    const auto part = read_image(folder_.file("x.pnm", above));
    ASSERT_FALSE(part.ok());
    EXPECT_THAT(part.error().message, HasSubstr("the white of its header: export it again"));
  }
  for (const char* wrong : {"P1 2 2 01 1", "P2 2 2 9 9 0 0 10", "P2 2 2 0 0 0 0 0", "P5 2 2 70000 ", "P6 0 1 255 ",
                            "P5 2 2 255 xxx", "P3 x", "Pf 1 1 0 xxxx"})
    EXPECT_FALSE(read_image(folder_.file("x.pnm", wrong)).ok()) << wrong;
}

}  // namespace
}  // namespace goniochrome::image::png_test
