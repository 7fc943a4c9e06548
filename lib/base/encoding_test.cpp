#include "base/encoding.h"

#include <gtest/gtest.h>

namespace goniochrome::encoding_test {
namespace {

using namespace std::string_view_literals;

TEST(Encoding, ReadsBothOrdersOfBytesInAnyPieces) {
  const std::string_view little = "\xff\xfe\x41\x00\xe4\x00\xac\x20\x3d\xd8\x00\xde"sv,
                         big = "\xfe\xff\x00\x41\x00\xe4\x20\xac\xd8\x3d\xde\x00"sv;
  const std::string wanted =
      "\xef\xbb\xbf"
      "A\xc3\xa4\xe2\x82\xac\xf0\x9f\x98\x80";
  for (const std::string_view bytes : {little, big}) {
    EXPECT_EQ(as_utf8(bytes), wanted);
    Utf8Decoder decoder;
    std::string text;
    for (const char byte : bytes) decoder.append(std::string_view(&byte, 1), text);
    EXPECT_EQ(text, wanted);
  }
}

TEST(Encoding, LeavesOtherTextsAsTheyAre) {
  for (const std::string_view text : {"", "a", "\xef\xbb\xbfs", "\xfe\x41", "\xff\x41"}) EXPECT_EQ(as_utf8(text), text);
}

TEST(Encoding, HalfAPairIsNoCharacter) {
  EXPECT_EQ(as_utf8("\xff\xfe\x3d\xd8\x41\x00"sv),
            "\xef\xbb\xbf\xed\xa0\xbd"
            "A");
}

}  // namespace
}  // namespace goniochrome::encoding_test
