#include "base/encode.h"

#include <gtest/gtest.h>

namespace goniochrome::encode_test {
namespace {

// The examples of RFC 4648, section 10.
TEST(Encode, Base64) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foob"), "Zm9vYg==");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xff\xfe"), "///+");
}

TEST(Encode, PartsOfAddresses) {
  EXPECT_EQ(percent_encoded("a-B_9.~"), "a-B_9.~");
  EXPECT_EQ(percent_encoded("a b/c#<\">&\xc3\xa9"), "a%20b%2Fc%23%3C%22%3E%26%C3%A9");
  EXPECT_EQ(percent_encoded("../my page.html", "/"), "../my%20page.html");
}

}  // namespace
}  // namespace goniochrome::encode_test
