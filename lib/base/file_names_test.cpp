#include "base/file_names.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "base/text.h"

namespace goniochrome::file_names_test {
namespace {

using testing::HasSubstr;

FileNames names_of(const std::string& pattern) {
  return FileNames::create(pattern, {"name", "code", "index"}, "--output").value();
}

TEST(FileName, OfAPaintCanBeWrittenEverywhere) {
  EXPECT_EQ(safe_file_name("silver fine 3.1+"), "silver fine 3.1+");
  EXPECT_EQ(safe_file_name("../../etc/passwd"), "_._.._etc_passwd");
  EXPECT_EQ(safe_file_name("a/b\\c:d*e?f\"g<h>i|j\nk"), "a_b_c_d_e_f_g_h_i_j_k");
  EXPECT_EQ(safe_file_name("."), "_");
  EXPECT_EQ(safe_file_name(""), "_");
  EXPECT_EQ(safe_file_name("ends. ."), "ends___");
  EXPECT_EQ(safe_file_name("r\xC3\xA9\xC3\xA9l"), "r\xC3\xA9\xC3\xA9l");
}

// A name of characters of two bytes each, whose number of bytes is odd where it is cut.
TEST(FileName, IsCutBetweenCharacters) {
  std::string name = "x";
  for (int i = 0; i < 300; ++i) name += "\xC3\xA9";
  const std::string safe = safe_file_name(name);
  EXPECT_EQ(safe.size(), 179u);
  EXPECT_TRUE(is_plain_utf8(safe));
}

TEST(FileName, FollowsThePattern) {
  FileNames names = names_of("out/{index}-{name}-{code}.png");
  EXPECT_TRUE(names.has("code"));
  EXPECT_EQ(names.next(7, "red", "R1"), "out/0007-red-R1.png");
  EXPECT_EQ(names.next(12345, "blue", ""), "out/12345-blue-blue.png");
  EXPECT_FALSE(names_of("{name}.png").has("index"));
}

TEST(FileName, ThatCollidesIsToldApart) {
  FileNames names = names_of("{name}.png");
  std::set<std::string> all;
  for (const char* name : {"a/b", "a:b", "a_b", "a_b-2", "a?b", "c"}) all.insert(names.next(1, name, ""));
  EXPECT_EQ(all, (std::set<std::string>{"a_b.png", "a_b-2.png", "a_b-3.png", "a_b-2-2.png", "a_b-4.png", "c.png"}));
}

TEST(FileName, PatternIsKnownByItsWords) {
  EXPECT_TRUE(FileNames::is_pattern("x/{code}.png"));
  EXPECT_FALSE(FileNames::is_pattern("{face}.png"));
  EXPECT_FALSE(FileNames::is_pattern("name.png"));
  const auto wrong = FileNames::create("{face}-{name}.png", {"name", "index"}, "--output");
  ASSERT_FALSE(wrong.ok());
  EXPECT_THAT(wrong.error().message, HasSubstr("{face} is not known here: there is {name}, {index}"));
  EXPECT_EQ(FileNames::create("a{b.png", {"name"}, "--output")->next(1, "x", ""), "a{b.png");
}

TEST(FileName, MisspelledWordIsToldAndOtherBracesAreNot) {
  const std::vector<std::string> words = {"name", "code"};
  for (const char* wrong : {"{nme}.png", "a/{Name}.png", "{name}-{cod}.png", "{{x}.png"}) {
    const auto checked = FileNames::check(wrong, words, "--picture");
    ASSERT_FALSE(checked.ok()) << wrong;
    EXPECT_EQ(checked.error().kind, ErrorKind::kUsage);
    EXPECT_THAT(checked.error().message, HasSubstr("is not known here: there is {name}, {code}"));
  }
  for (const char* fine : {"{name}.png", "a.png", "{1}.png", "{}.png", "{a b}.png", "{nme", "nme}", "{3f2a-11}.png"})
    EXPECT_TRUE(FileNames::check(fine, words, "--picture").ok()) << fine;
}

}  // namespace
}  // namespace goniochrome::file_names_test
