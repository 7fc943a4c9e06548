#include "base/text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <type_traits>

namespace goniochrome {

namespace {

// std::from_chars takes no leading '+', which instruments do print.
std::string_view without_plus(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  return text;
}

#ifdef __cpp_lib_to_chars
using std::from_chars;
#else
// The standard library for WebAssembly has std::from_chars of whole numbers alone. strtod() takes more than that, and
// WebAssembly has no locale but the C locale.
std::from_chars_result from_chars(const char* first, const char* last, double& value) {
  const std::string text(first, last);
  char* end = nullptr;
  if (text.find_first_not_of("0123456789.eE+-") == std::string::npos && !text.starts_with('+'))
    value = std::strtod(text.c_str(), &end);
  const bool read = end != nullptr && end != text.c_str() && std::isfinite(value);
  return {read ? first + (end - text.c_str()) : first, read ? std::errc{} : std::errc::invalid_argument};
}
template <class Integer>
requires std::is_integral_v<Integer> std::from_chars_result from_chars(const char* first, const char* last,
                                                                       Integer& value) {
  return std::from_chars(first, last, value);
}
#endif

template <class Number>
std::optional<Number> parsed_whole(std::string_view text) {
  text = without_plus(text);
  Number value{};
  const auto [end, status] = from_chars(text.data(), text.data() + text.size(), value);
  if (status != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

// `text` with the letters from `first` to `last` moved to the alphabet that begins at `to`.
std::string in_case(std::string_view text, char first, char last, char to) {
  std::string result(text);
  for (char& c : result)
    if (c >= first && c <= last) c = static_cast<char>(c - first + to);
  return result;
}

// Characters that print as a blank or as nothing: no-break and typographic spaces, marks without width.
struct Invisible {
  std::string_view bytes, name;
};
constexpr std::array kInvisible = {Invisible{"\xc2\xa0", "<U+00A0>"},     Invisible{"\xe2\x80\x87", "<U+2007>"},
                                   Invisible{"\xe2\x80\x89", "<U+2009>"}, Invisible{"\xe2\x80\xaf", "<U+202F>"},
                                   Invisible{"\xe3\x80\x80", "<U+3000>"}, Invisible{"\xe2\x80\x8b", "<U+200B>"},
                                   Invisible{"\xef\xbb\xbf", "<U+FEFF>"}};

const Invisible* invisible_at_front(std::string_view text) {
  if (text.empty() || static_cast<unsigned char>(text.front()) < 0x80) return nullptr;
  const auto found = std::ranges::find_if(kInvisible, [&](const Invisible& c) { return text.starts_with(c.bytes); });
  return found == kInvisible.end() ? nullptr : &*found;
}

// The length of the character at the front of `text`, or 0 if XML 1.0 does not allow it.
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

std::optional<double> parse_number(std::string_view text) {
  const auto value = parsed_whole<double>(text);
  if (!value || !std::isfinite(*value)) return std::nullopt;
  return value;
}

std::optional<std::int64_t> parse_integer(std::string_view text) {
  return parsed_whole<std::int64_t>(text);
}

std::string shortest(double value) {
  std::array<char, 32> buffer;
  const auto [end, status] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return std::string(buffer.data(), end);
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r\n\v\f";
  for (;;) {
    text.remove_prefix(std::min(text.find_first_not_of(kSpace), text.size()));
    const Invisible* invisible = invisible_at_front(text);
    if (!invisible) break;
    text.remove_prefix(invisible->bytes.size());
  }
  for (;;) {
    text = text.substr(0, text.find_last_not_of(kSpace) + 1);
    if (text.empty() || static_cast<unsigned char>(text.back()) < 0x80) return text;
    const auto last = std::ranges::find_if(kInvisible, [&](const Invisible& c) { return text.ends_with(c.bytes); });
    if (last == kInvisible.end()) return text;
    text.remove_suffix(last->bytes.size());
  }
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> pieces;
  for (;;) {
    const auto at = text.find(separator);
    pieces.push_back(text.substr(0, at));
    if (at == std::string_view::npos) return pieces;
    text.remove_prefix(at + 1);
  }
}

std::string joined(const std::vector<std::string>& words, std::string_view separator) {
  std::string text;
  for (const std::string& word : words) {
    if (&word != words.data()) text += separator;
    text += word;
  }
  return text;
}

std::string lower(std::string_view text) {
  return in_case(text, 'A', 'Z', 'a');
}

std::string upper(std::string_view text) {
  return in_case(text, 'a', 'z', 'A');
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (a[i - 1] == b[j - 1] ? 0 : 1)});
      diagonal = above;
    }
  }
  return row[b.size()];
}

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
    else if (const Invisible* invisible = invisible_at_front(text))
      line += invisible->name;
    else
      line += text[0] < ' ' && text[0] >= 0 ? " " : text.substr(0, length);
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return text.empty() ? line : line + "...";
}

std::string xml_escaped(std::string_view text, std::string_view as_numbers) {
  if (!is_plain_utf8(text)) return xml_escaped(plain_utf8(text), as_numbers);
  std::string escaped;
  escaped.reserve(text.size());
  for (const char c : text)
    if (const auto at = std::string_view("&<>\"").find(c); at != std::string_view::npos)
      escaped += std::array{"&amp;", "&lt;", "&gt;", "&quot;"}[at];
    else if (as_numbers.find(c) != std::string_view::npos)
      escaped += "&#" + std::to_string(static_cast<int>(c)) + ';';
    else
      escaped += c;
  return escaped;
}

}  // namespace goniochrome
