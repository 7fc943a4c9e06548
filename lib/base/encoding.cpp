#include "base/encoding.h"

#include <array>
#include <cstdint>

#include "base/text.h"

namespace goniochrome {

namespace {

// The characters 0x80 to 0x9F of Windows-1252; those that it leaves open are the replacement character.
constexpr std::array<std::uint32_t, 32> kWindows1252 = {0x20ac, 0xfffd, 0x201a, 0x0192, 0x201e, 0x2026, 0x2020, 0x2021,
                                                        0x02c6, 0x2030, 0x0160, 0x2039, 0x0152, 0xfffd, 0x017d, 0xfffd,
                                                        0xfffd, 0x2018, 0x2019, 0x201c, 0x201d, 0x2022, 0x2013, 0x2014,
                                                        0x02dc, 0x2122, 0x0161, 0x203a, 0x0153, 0xfffd, 0x017e, 0x0178};

constexpr std::string_view kLittleEndianMark = "\xff\xfe", kBigEndianMark = "\xfe\xff";

void append_utf8(std::uint32_t code, std::string& text) {
  const auto tail = [&](int shift) { text += static_cast<char>(0x80 | ((code >> shift) & 0x3f)); };
  if (code < 0x80) {
    text += static_cast<char>(code);
  } else if (code < 0x800) {
    text += static_cast<char>(0xc0 | code >> 6);
    tail(0);
  } else if (code < 0x10000) {
    text += static_cast<char>(0xe0 | code >> 12);
    tail(6), tail(0);
  } else {
    text += static_cast<char>(0xf0 | code >> 18);
    tail(12), tail(6), tail(0);
  }
}

}  // namespace

void Utf8Decoder::append(std::string_view bytes, std::string& text) {
  if (encoding_ == Encoding::kPlain) {
    text += bytes;
    return;
  }
  rest_ += bytes;
  if (encoding_ == Encoding::kUnknown) {
    const bool may_be_mark = kLittleEndianMark.starts_with(rest_) || kBigEndianMark.starts_with(rest_);
    if (rest_.size() < 2 && may_be_mark) return;
    encoding_ = rest_.starts_with(kLittleEndianMark) ? Encoding::kLittleEndian
                : rest_.starts_with(kBigEndianMark)  ? Encoding::kBigEndian
                                                     : Encoding::kPlain;
    if (encoding_ == Encoding::kPlain) {
      text += rest_;
      rest_.clear();
      return;
    }
  }
  const auto unit = [&](std::size_t at) -> std::uint32_t {
    const auto first = static_cast<unsigned char>(rest_[at]), second = static_cast<unsigned char>(rest_[at + 1]);
    return encoding_ == Encoding::kLittleEndian ? second << 8 | first : first << 8 | second;
  };
  std::size_t at = 0;
  while (at + 2 <= rest_.size()) {
    std::uint32_t code = unit(at);
    const bool begins_pair = code >= 0xd800 && code < 0xdc00;
    if (begins_pair && at + 4 > rest_.size()) break;
    at += 2;
    if (begins_pair && unit(at) >= 0xdc00 && unit(at) < 0xe000) {
      code = 0x10000 + ((code - 0xd800) << 10) + (unit(at) - 0xdc00);
      at += 2;
    }
    append_utf8(code, text);
  }
  rest_.erase(0, at);
}

std::string as_utf8(std::string_view bytes) {
  std::string text;
  Utf8Decoder().append(bytes, text);
  return text;
}

std::string decoded_text(std::string_view bytes, bool& is_windows_1252) {
  std::string text = as_utf8(bytes);
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
  std::erase_if(text,
                [](char c) { return static_cast<unsigned char>(c) < 0x20 && c != '\t' && c != '\n' && c != '\r'; });
  is_windows_1252 = !is_plain_utf8(text);
  if (!is_windows_1252) return text;
  std::string converted;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    append_utf8(byte >= 0x80 && byte < 0xa0 ? kWindows1252[byte - 0x80] : byte, converted);
  }
  return converted;
}

}  // namespace goniochrome
