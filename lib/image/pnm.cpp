#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>

#include "base/text.h"
#include "image/internal/exr.h"
#include "image/internal/other_formats.h"

// After P and a digit come the width, the height and, but for bitmaps, the value that stands for 1, between white space
// and comments. P1 to P3 go on with numbers as text, P4 to P6 with bytes: a bit for each pixel of a bitmap, where 1 is
// black, in rows of whole bytes; else one byte for each sample, or two from the larger where 1 stands above 255. PF and
// Pf hold floats from the bottom row on, little-endian where the third number is negative. [Netpbm; Debevec, PFM]

namespace goniochrome::image {

namespace {

bool is_space(char c) {
  return c == ' ' || (c >= '\t' && c <= '\r');
}

class Words {
 public:
  explicit Words(std::string_view rest) : rest_(rest) {}

  // The next word, up to white space or a comment; empty at the end.
  std::string_view next() {
    skip();
    std::size_t size = 0;
    while (size < rest_.size() && !is_space(rest_[size]) && rest_[size] != '#') ++size;
    return taken(size);
  }
  // The next digit, which may touch its neighbor.
  std::string_view next_digit() {
    skip();
    return taken(rest_.empty() ? 0 : 1);
  }
  // The bytes behind the one white space that ends the header, or behind the two of a line as Windows ends it, where
  // `size` are left.
  std::string_view bytes(std::size_t size) const {
    const bool ends_twice = rest_.starts_with("\r\n") && rest_.size() - 2 >= size;
    return rest_.empty() ? rest_ : rest_.substr(ends_twice ? 2 : 1);
  }

 private:
  std::string_view taken(std::size_t size) {
    const std::string_view word = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return word;
  }
  void skip() {
    while (!rest_.empty() && (is_space(rest_[0]) || rest_[0] == '#')) {
      const std::size_t end = rest_[0] == '#' ? rest_.find('\n') : 1;
      rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end);
    }
  }
  std::string_view rest_;
};

struct Header {
  char kind = 0;
  std::size_t width = 0, height = 0, channels = 1;
  double most = 1;
  bool is_float() const { return kind == 'F' || kind == 'f'; }
  bool is_text() const { return kind >= '1' && kind <= '3'; }
  bool is_bitmap() const { return kind == '1' || kind == '4'; }
  std::size_t row_samples() const { return width * channels; }
  std::size_t row_bytes() const {
    if (kind == '4') return (width + 7) / 8;
    if (is_float()) return 4 * row_samples();
    return row_samples() * (is_text() || most <= 255 ? 1 : 2);  // a number of a text has one digit at least
  }
};

std::optional<Header> header_of(char kind, Words& words) {
  Header header{kind};
  const auto width = parse_integer(words.next()), height = parse_integer(words.next());
  constexpr auto kMost = static_cast<std::int64_t>(kMostSamples);
  if (!width || !height || *width < 1 || *height < 1 || *width > kMost || *height > kMost) return std::nullopt;
  header.width = static_cast<std::size_t>(*width), header.height = static_cast<std::size_t>(*height);
  header.channels = kind == '3' || kind == '6' || kind == 'F' ? 3 : 1;
  if (header.is_bitmap()) return header;
  const auto most = parse_number(words.next());
  if (!most || *most == 0) return std::nullopt;
  if (!header.is_float() && !(*most >= 1 && *most <= 65535 && *most == std::floor(*most))) return std::nullopt;
  header.most = *most;
  return header;
}

// True if all numbers were there, each within 0 and the one that stands for 1.
bool read_text(const Header& header, Words words, std::vector<float>& to) {
  for (float& value : to) {
    const auto number = parse_integer(header.is_bitmap() ? words.next_digit() : words.next());
    if (!number || *number < 0 || static_cast<double>(*number) > header.most) return false;
    value = static_cast<float>(header.is_bitmap() ? 1 - *number : *number / header.most);
  }
  return true;
}

float float_at(const unsigned char* bytes, bool little) {
  std::uint32_t bits = 0;
  for (int i = 0; i < 4; ++i) bits |= std::uint32_t{bytes[i]} << 8 * (little ? i : 3 - i);
  return std::bit_cast<float>(bits);
}

void read_row(const Header& header, const unsigned char* from, float* to) {
  for (std::size_t i = 0; i < header.row_samples(); ++i) {
    if (header.is_float())
      to[i] = float_at(from + 4 * i, header.most < 0) * static_cast<float>(std::fabs(header.most));
    else if (header.is_bitmap())
      to[i] = static_cast<float>(1 - (from[i / 8] >> (7 - i % 8) & 1));
    else if (header.most > 255)
      to[i] = static_cast<float>((from[2 * i] << 8 | from[2 * i + 1]) / header.most);
    else
      to[i] = static_cast<float>(from[i] / header.most);
  }
}

}  // namespace

Result<ImagePart> decoded_pnm(const std::string& content, const std::string& name) {
  Words words(std::string_view(content).substr(2));
  const auto header = header_of(content[1], words);
  if (!header)
    return input_error(
        "{}: cannot be read as an image: its PNM header does not say a width, a height and the value of white: export "
        "it again",
        name);
  if (header->width * header->height > kMostSamples / header->channels)
    return input_error("{}: cannot be read as an image: its header says more pixels than fit into 8 GB: is it damaged?",
                       name);
  const std::string_view bytes = words.bytes(header->row_bytes() * header->height);
  if (bytes.size() / header->row_bytes() < header->height)
    return input_error(
        "{}: cannot be read as an image: its header says more pixels than a file of its size can hold: is it damaged?",
        name);
  ImagePart part;
  part.type = PixelType::kFloat;
  part.image = {static_cast<int>(header->width), static_cast<int>(header->height), static_cast<int>(header->channels),
                {}, {}};
  part.image.channel_names = header->channels == 3 ? std::vector<std::string>{"R", "G", "B"}
                                                   : std::vector<std::string>{"Y"};
  part.attributes["oiio:ColorSpace"] = std::string(header->is_float() ? "linear" : "Rec709");
  part.attributes["goniochrome:integer"] = header->is_float() ? 0 : 1;
  std::vector<float>& data = part.image.data;
  data.resize(header->row_samples() * header->height);
  if (header->is_text()) {
    if (!read_text(*header, words, data))
      return input_error("{}: cannot be read as an image: a number is missing or above {}: is it cut short?", name,
                         header->most);
    return part;
  }
  for (std::size_t y = 0; y < header->height; ++y) {
    const std::size_t row = header->is_float() ? header->height - 1 - y : y;
    read_row(*header, reinterpret_cast<const unsigned char*>(bytes.data()) + y * header->row_bytes(),
             &data[row * header->row_samples()]);
  }
  if (!header->is_float() && std::ranges::any_of(data, [](float value) { return value > 1; }))
    return input_error(
        "{}: cannot be read as an image: a value is above {}, the white of its header: export it again, and if it has "
        "two bytes a value, with the larger one first",
        name, header->most);
  return part;
}

}  // namespace goniochrome::image
