#include "formats/encoding.h"

#include <cstdint>

namespace goniochrome::formats {

namespace {

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

}  // namespace goniochrome::formats
