#include "base/text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

namespace goniochrome::text_test {
namespace {

TEST(Text, NumbersParseWholeOrNotAtAll) {
  EXPECT_EQ(parse_number("12.5"), 12.5);
  EXPECT_EQ(parse_number("+3e2"), 300.0);
  EXPECT_EQ(parse_number("-0"), 0.0);
  for (const char* bad : {"", " 1", "1 ", "64abc", "12,5", "0x10", "inf", "nan", "1e999", "--1", "+-1", "."})
    EXPECT_FALSE(parse_number(bad)) << bad;
  EXPECT_EQ(parse_integer("64"), 64);
  for (const char* bad : {"64abc", "6.4", "", "99999999999999999999"}) EXPECT_FALSE(parse_integer(bad)) << bad;
}

TEST(Text, ShortestReadsBackExactly) {
  std::mt19937_64 random(7);
  for (int i = 0; i < 20000; ++i) {
    const std::uint64_t bits = random();
    double value;
    static_assert(sizeof value == sizeof bits);
    std::memcpy(&value, &bits, sizeof value);
    if (!std::isfinite(value)) continue;
    EXPECT_EQ(parse_number(shortest(value)), value);
  }
  EXPECT_EQ(shortest(0.1), "0.1");
}

TEST(Text, SplitKeepsEmptyPieces) {
  EXPECT_EQ(split("a,,b", ',').size(), 3u);
  EXPECT_EQ(split("", ',').size(), 1u);
  EXPECT_EQ(trimmed("  a b\r\n"), "a b");
  EXPECT_EQ(lower("As-15"), "as-15");
}

TEST(Text, SpacesThatLookLikeBlanksAreTrimmedAndShown) {
  EXPECT_EQ(trimmed("\xc2\xa0 45as15\xe2\x80\xaf \xef\xbb\xbf"), "45as15");
  EXPECT_EQ(trimmed(" \xc2\xa0 "), "");
  EXPECT_EQ(trimmed("a\xc2\xa0z"), "a\xc2\xa0z");
  EXPECT_EQ(shown("a\xc2\xa0z\xe2\x80\x8b"), "a<U+00A0>z<U+200B>");
}

}  // namespace
}  // namespace goniochrome::text_test
