#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>
#include <utility>

#include "image/internal/exr_header.h"

namespace goniochrome::image {

namespace {

// Bytes that are read from the front. Each function returns nothing if there are too few.
class Bytes {
 public:
  explicit Bytes(std::string_view rest) : rest_(rest) {}

  bool empty() const { return rest_.empty(); }
  std::size_t size() const { return rest_.size(); }

  std::optional<std::string_view> taken(std::size_t count) {
    if (count > rest_.size()) return {};
    const std::string_view head = rest_.substr(0, count);
    rest_.remove_prefix(count);
    return head;
  }

  // A text that a zero ends, without the zero.
  std::optional<std::string_view> text() {
    const std::size_t end = rest_.find('\0');
    if (end == std::string_view::npos) return {};
    const std::string_view head = rest_.substr(0, end);
    rest_.remove_prefix(end + 1);
    return head;
  }

  // Four bytes, the least significant first.
  std::optional<std::uint32_t> number() {
    const auto four = taken(4);
    if (!four) return {};
    std::uint32_t value = 0;
    for (int i = 3; i >= 0; --i) value = value << 8 | static_cast<unsigned char>((*four)[static_cast<std::size_t>(i)]);
    return value;
  }

 private:
  std::string_view rest_;
};

// A list of channels, each a name and 16 bytes; an empty name ends it.
bool is_channel_list(Bytes value) {
  while (const auto name = value.text()) {
    if (name->empty()) return value.empty();
    if (!value.taken(16)) return false;
  }
  return false;
}

bool is_list_of_texts(Bytes value) {
  while (!value.empty()) {
    const auto size = value.number();
    if (!size || !value.taken(*size)) return false;
  }
  return true;
}

// Width, height, and four bytes for each pixel.
bool is_preview(Bytes value) {
  const auto width = value.number(), height = value.number();
  return width && height && value.size() % 4 == 0 && std::uint64_t{*width} * *height == value.size() / 4;
}

// The bytes that a value of each type takes, where all values of the type take as many.
constexpr std::array<std::pair<std::string_view, std::size_t>, 24> kSizes{{
    {"box2f", 16},
    {"box2i", 16},
    {"chromaticities", 32},
    {"compression", 1},
    {"deepImageState", 1},
    {"double", 8},
    {"envmap", 1},
    {"float", 4},
    {"int", 4},
    {"keycode", 28},
    {"lineOrder", 1},
    {"m33d", 72},
    {"m33f", 36},
    {"m44d", 128},
    {"m44f", 64},
    {"rational", 8},
    {"tiledesc", 9},
    {"timecode", 8},
    {"v2d", 16},
    {"v2f", 8},
    {"v2i", 8},
    {"v3d", 24},
    {"v3f", 12},
    {"v3i", 12},
}};

bool is_value(std::string_view type, std::string_view value) {
  if (type == "chlist") return is_channel_list(Bytes(value));
  if (type == "stringvector") return is_list_of_texts(Bytes(value));
  if (type == "preview") return is_preview(Bytes(value));
  for (const auto& [name, size] : kSizes)
    if (name == type) return size == value.size();
  return true;
}

}  // namespace

bool is_sound_exr_header(const std::string& content) {
  Bytes rest(content);
  const auto start = rest.taken(8);
  if (!start) return false;
  const bool has_several_parts = (static_cast<unsigned char>((*start)[5]) & 0x10) != 0;
  // A header is a list of name, type, size and value, which an empty name ends; so is the list of headers.
  for (bool first = true;; first = false) {
    auto name = rest.text();
    if (name && name->empty() && !first) return !rest.empty();
    for (; name && !name->empty(); name = rest.text()) {
      const auto type = rest.text();
      const auto size = rest.number();
      const auto value = type && size ? rest.taken(*size) : std::nullopt;
      if (!value || !is_value(*type, *value)) return false;
    }
    if (!name) return false;
    if (!has_several_parts) return !rest.empty();
  }
}

}  // namespace goniochrome::image
