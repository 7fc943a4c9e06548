#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "image/internal/content_format.h"

namespace goniochrome::image::content_format_test {
namespace {

using testing::HasSubstr;

// A number of 4 bytes, lowest first.
std::string little(std::uint32_t value) {
  std::string bytes;
  for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(value >> shift);
  return bytes;
}

// The first bytes of files that are known by them, and others behind.
TEST(ContentFormat, AFileThatEndsWithinItsHeaderIsNamedOrRefused) {
  using namespace std::string_literals;
  const std::string heads[] = {
      "\x76\x2f\x31\x01"s, "#?RADIANCE"s, "\x89PNG\r\n\x1a\n"s, "\xff\xd8\xff"s, "II\x2a\0"s, "MM\0\x2a"s, "II\x2b\0"s,
      "MM\0\x2b"s,         "SDPX"s,       "RIFF....WEBPVP8"s,   "BM"s,           "FOR4"s,     "P6 "s,      "\0\0\x02"s,
      "\0\0\0\x0cjP  "s};
  for (const std::string& head : heads)
    for (const char filling : {'\0', '\x08', '\xff'}) {
      const std::string whole = head + std::string(24, filling);
      for (std::size_t size = 0; size < whole.size(); ++size) {
        const auto format = content_format(whole.substr(0, size), "x");
        if (format.ok()) continue;
        EXPECT_THAT(format.error().message, HasSubstr("x: is ")) << size << " bytes of " << head;
      }
    }
}

// A header of 124 bytes tells the kind of its colors at 56, and place and size of a profile at 112 and 116.
TEST(ContentFormat, TheProfileOfABmpIsFound) {
  const auto bmp = [](std::uint32_t kind, std::uint32_t at) {
    return "BM" + std::string(12, '\0') + little(124) + std::string(52, '\0') + little(kind) + std::string(52, '\0') +
           little(at) + little(3) + std::string(4, '\0') + "xyz";
  };
  constexpr std::uint32_t kEmbedded = 0x4d424544, kSrgb = 0x73524742;
  EXPECT_EQ(std::get<std::string>(stated_colors(bmp(kEmbedded, 124), "bmp").at("ICCProfile")), "xyz");
  EXPECT_TRUE(stated_colors(bmp(kSrgb, 124), "bmp").empty()) << "control";
  EXPECT_TRUE(stated_colors(bmp(kEmbedded, 1U << 30), "bmp").empty()) << "a place behind the end";
}

TEST(ContentFormat, OrientationOfAWebpIsFound) {
  using namespace std::string_literals;
  const std::string pixels = "VP8 \3\0\0\0abc\0"s, exif = "MM\0\x2a\0\0\0\x08\0\1\x01\x12\0\3\0\0\0\1\0\6\0\0\0\0\0\0"s;
  const std::string head = "RIFF\0\0\0\0WEBP"s, size = "\x1a\0\0\0"s, longer = "\x20\0\0\0"s;
  ASSERT_EQ(exif.size(), 26U);
  EXPECT_EQ(exif_orientation(head + pixels, "webp"), 1);
  EXPECT_EQ(exif_orientation(head + pixels + "EXIF" + size + exif, "webp"), 6);
  EXPECT_EQ(exif_orientation(head + pixels + "EXIF" + longer + "Exif\0\0"s + exif, "webp"), 6);
  const std::string whole = head + pixels + "EXIF" + size + exif;
  for (std::size_t cut = 0; cut < whole.size(); ++cut)
    EXPECT_EQ(exif_orientation(whole.substr(0, cut), "webp"), 1) << cut;
}

// The profile of a WebP, the primaries of a TIFF and the Adobe RGB of cameras were dropped in silence.
TEST(ContentFormat, ColorsThatFilesStateAreFound) {
  using namespace std::string_literals;
  const std::string webp = "RIFF\0\0\0\0WEBPVP8 \2\0\0\0abICCP\3\0\0\0xyz\0"s;
  EXPECT_EQ(std::get<std::string>(stated_colors(webp, "webp").at("ICCProfile")), "xyz");
  EXPECT_TRUE(stated_colors(webp.substr(0, 22), "webp").empty()) << "control";
  // Directories of one entry each: EXIF at 26, interoperability at 44.
  const auto directory = [](const std::string& tag, const std::string& type, const std::string& value) {
    return "\0\1"s + tag + type + "\0\0\0\4"s + value + "\0\0\0\0"s;
  };
  const auto exif = [&](const std::string& index) {
    return "MM\0\x2a\0\0\0\x08"s + directory("\x87\x69"s, "\0\4"s, "\0\0\0\x1a"s) +
           directory("\xa0\x05"s, "\0\4"s, "\0\0\0\x2c"s) + directory("\0\1"s, "\0\2"s, index + "\0"s);
  };
  const auto jpeg = [&](const std::string& header) {
    return "\xff\xd8\xff\xe1\0"s + static_cast<char>(header.size() + 8) + "Exif\0\0"s + header + "\xff\xda"s;
  };
  const Attributes adobe = stated_colors(jpeg(exif("R03")), "jpeg");
  EXPECT_EQ(std::get<std::vector<float>>(adobe.at("chromaticities"))[2], .21F);
  EXPECT_TRUE(stated_colors(jpeg(exif("R98")), "jpeg").empty()) << "sRGB";
  // Two tags whose rationals stand at 38.
  std::string tiff =
      "MM\0\x2a\0\0\0\x08\0\2"s + "\1\x3e\0\5\0\0\0\2\0\0\0\x56"s + "\1\x3f\0\5\0\0\0\6\0\0\0\x26"s + "\0\0\0\0"s;
  for (int i = 1; i <= 8; ++i) tiff += "\0\0\0"s + static_cast<char>(i) + "\0\0\0\x0a"s;
  const Attributes primaries = stated_colors(tiff, "tiff");
  EXPECT_EQ(std::get<std::vector<float>>(primaries.at("chromaticities")),
            (std::vector<float>{.1F, .2F, .3F, .4F, .5F, .6F, .7F, .8F}));
  for (std::size_t cut = 0; cut < tiff.size(); ++cut) EXPECT_TRUE(stated_colors(tiff.substr(0, cut), "tiff").empty());
}

}  // namespace
}  // namespace goniochrome::image::content_format_test
