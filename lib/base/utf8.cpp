#include "base/utf8.h"

#include <cstddef>

namespace goniochrome {

namespace {

// The length of the character at the front of `text`, or 0 if it is none that XML 1.0 allows.
std::size_t character_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(0);
  if (first < 0x80) return first >= 0x20 || first == '\t' || first == '\n' || first == '\r' ? 1 : 0;
  const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4 || text.size() < length) return 0;
  unsigned code = first & (0x7fu >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return 0;
    code = code << 6 | (byte(i) & 0x3fu);
  }
  const bool too_long = (length == 3 && code < 0x800) || (length == 4 && code < 0x10000);
  const bool surrogate = code >= 0xd800 && code < 0xe000;
  if (too_long || surrogate || code > 0x10ffff || code == 0xfffe || code == 0xffff) return 0;
  return length;
}

}  // namespace

bool is_plain_utf8(std::string_view text) {
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    if (length == 0) return false;
    text.remove_prefix(length);
  }
  return true;
}

std::string plain_utf8(std::string_view text) {
  std::string plain;
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    plain += length == 0 ? "?" : text.substr(0, length);
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return plain;
}

std::string shown(std::string_view text) {
  constexpr std::size_t kMost = 60;
  std::string line;
  while (!text.empty() && line.size() < kMost) {
    const std::size_t length = character_length(text);
    if (length == 0)
      line += '?';
    else
      line += text[0] < ' ' && text[0] >= 0 ? " " : text.substr(0, length);
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return text.empty() ? line : line + "...";
}

}  // namespace goniochrome
