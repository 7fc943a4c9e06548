#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "image/internal/content_format.h"

namespace goniochrome::image::content_format_test {
namespace {

using testing::HasSubstr;

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

}  // namespace
}  // namespace goniochrome::image::content_format_test
