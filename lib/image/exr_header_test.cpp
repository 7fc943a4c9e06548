#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <string>

#include "image/exr.h"
#include "image/internal/exr_header.h"

namespace goniochrome::image::exr_header_test {
namespace {

using namespace std::string_literals;

std::string number(std::uint32_t value) {
  std::string bytes(4, '\0');
  for (std::size_t i = 0; i < 4; ++i) bytes[i] = static_cast<char>(value >> 8 * i & 0xFF);
  return bytes;
}

std::string attribute(const std::string& name, const std::string& type, const std::string& value) {
  return name + '\0' + type + '\0' + number(static_cast<std::uint32_t>(value.size())) + value;
}

// A file that has the attributes `header` and some pixels.
std::string file_with(const std::string& header, char flags = '\0') {
  return "\x76\x2f\x31\x01\x02"s + flags + "\0\0"s + header + "\0pixels"s;
}

std::string channel(const std::string& name) {
  return name + '\0' + std::string(16, '\1');
}

// A check that is enough for attributes that end within the file: sizes are added, and types are not looked at.
bool ends_within_by_stated_sizes(const std::string& content) {
  std::size_t at = 8;
  while (content[at] != '\0') {
    for (int texts = 0; texts < 2; ++texts) at = content.find('\0', at) + 1;
    std::uint32_t size = 0;
    if (content.size() < at + 4) return false;
    std::memcpy(&size, content.data() + at, 4);
    at += 4 + size;
    if (at >= content.size()) return false;
  }
  return true;
}

TEST(ExrHeader, IsSoundIfEachValueHasTheSizeOfItsType) {
  for (const std::string& header :
       {attribute("channels", "chlist", channel("B") + channel("G") + "\0"s), attribute("weight", "float", "1234"),
        attribute("views", "stringvector", number(4) + "left" + number(0)), attribute("owner", "string", "a paint lab"),
        attribute("preview", "preview", number(2) + number(1) + "rgbaRGBA"),
        attribute("other", "unknown", "anything")}) {
    EXPECT_TRUE(is_sound_exr_header(file_with(header))) << header;
    EXPECT_TRUE(is_sound_exr_header(file_with(header + '\0' + header + '\0', 0x10))) << header << " in two parts";
    EXPECT_FALSE(is_sound_exr_header(file_with(header).substr(0, 8 + header.size()))) << header << " and no end";
  }
}

TEST(ExrHeader, IsDamagedWhereTheLibraryWouldReadAnotherSizeThanIsStated) {
  for (const std::string& header :
       {attribute("channels", "chlist", channel("B") + channel("G")), attribute("channels", "chlist", "\0more"s),
        attribute("weight", "float", "12345678"), attribute("window", "box2i", "12345678"),
        attribute("views", "stringvector", number(1U << 30) + "left"),
        attribute("preview", "preview", number(1U << 16) + number(1U << 16) + "rgba")}) {
    EXPECT_FALSE(is_sound_exr_header(file_with(header))) << header;
    // The sizes that are stated do not show it.
    EXPECT_TRUE(ends_within_by_stated_sizes(file_with(header))) << header;
  }
}

TEST(ExrHeader, ThatIsDamagedIsToldByTheFile) {
  const auto decoded = decoded_exr(file_with(attribute("weight", "float", "12345678")), "sky.exr");
  ASSERT_FALSE(decoded.ok());
  EXPECT_EQ(decoded.error().message, "sky.exr: its header is damaged or cut off");
}

}  // namespace
}  // namespace goniochrome::image::exr_header_test
