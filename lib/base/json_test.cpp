#include "base/json.h"

#include <gtest/gtest.h>

#include <limits>

namespace goniochrome::json_test {
namespace {

TEST(Json, KeepsItsKeysInTheOrderOfTheText) {
  EXPECT_EQ(json_text(parse_json(R"({"b": 1, "a": [2, null]})")), R"({"b":1,"a":[2,null]})");
  EXPECT_EQ(json_text(Json::parse("[1]"), 1), "[\n 1\n]");
}

TEST(Json, TellsATextThatIsNone) {
  EXPECT_TRUE(parse_json("{").is_discarded());
  EXPECT_TRUE(parse_json("").is_discarded());
}

TEST(Json, WritesBytesThatAreNotUtf8AsReplacementCharacters) {
  EXPECT_EQ(json_text(Json("a\xff")), "\"a\xEF\xBF\xBD\"");
}

TEST(Json, HasNoNumberThatIsNotFinite) {
  EXPECT_TRUE(json_number(std::numeric_limits<double>::infinity()).is_null());
}

}  // namespace
}  // namespace goniochrome::json_test
