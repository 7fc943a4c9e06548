// [Portable Network Graphics (Third Edition), 11.3.2; ITU-T H.273, tables 2 and 3]
#include "image/internal/png_colors.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string>

namespace goniochrome::image {

namespace {

std::uint32_t number_at(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = at; i < at + 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes[i]);
  return value;
}

// Hands the chunks to `take`, with their types, until that returns false.
template <class Take>
void for_chunks(std::string_view content, Take&& take) {
  constexpr std::size_t kMark = 8, kAround = 12;
  for (std::size_t at = kMark; at + kAround <= content.size();) {
    const std::size_t size = number_at(content, at);
    if (size > content.size() - at - kAround || !take(content.substr(at + 4, 4), content.substr(at + 8, size))) return;
    at += kAround + size;
  }
}

// The chunks before the pixels, by their types.
std::map<std::string, std::string_view, std::less<>> chunks_of(std::string_view content) {
  std::map<std::string, std::string_view, std::less<>> chunks;
  for_chunks(content, [&](std::string_view type, std::string_view data) {
    if (type == "IDAT") return false;
    chunks.try_emplace(std::string(type), data);
    return true;
  });
  return chunks;
}

std::optional<std::vector<float>> primaries_of(int code) {
  switch (code) {
    case 1:
      return std::vector<float>{.64F, .33F, .3F, .6F, .15F, .06F, .3127F, .329F};
    case 9:
      return std::vector<float>{.708F, .292F, .17F, .797F, .131F, .046F, .3127F, .329F};
    case 11:
      return std::vector<float>{.68F, .32F, .265F, .69F, .15F, .06F, .314F, .351F};
    case 12:
      return std::vector<float>{.68F, .32F, .265F, .69F, .15F, .06F, .3127F, .329F};
    default:
      return std::nullopt;
  }
}

// The name of the curve of whole numbers; the curves of video are those of its cameras, and are shown as sRGB is.
std::string curve_of(int code) {
  switch (code) {
    case 1:
    case 6:
    case 14:
    case 15:
      return "Rec709";
    case 4:
      return "Gamma2.2";
    case 5:
      return "Gamma2.8";
    case 8:
      return "linear";
    case 13:
      return "sRGB";
    default:
      return "";
  }
}

}  // namespace

Attributes png_colors(std::string_view content) {
  Attributes attributes;
  const auto chunks = chunks_of(content);
  if (const auto cicp = chunks.find("cICP"); cicp != chunks.end() && cicp->second.size() == 4) {
    const auto code = [&](std::size_t i) { return static_cast<int>(static_cast<unsigned char>(cicp->second[i])); };
    const auto primaries = primaries_of(code(0));
    const std::string curve = curve_of(code(1));
    const bool known = primaries && !curve.empty() && code(2) == 0 && code(3) == 1;
    attributes["oiio:ColorSpace"] = known ? curve : fmt::format("cICP {} {} {} {}", code(0), code(1), code(2), code(3));
    if (primaries) attributes["chromaticities"] = *primaries;
    return attributes;
  }
  const auto chrm = chunks.find("cHRM");
  if (chrm == chunks.end() || chrm->second.size() != 32 || chunks.contains("sRGB") || chunks.contains("iCCP"))
    return attributes;
  constexpr float kUnit = 1e-5F;
  const auto value = [&](std::size_t i) { return kUnit * static_cast<float>(number_at(chrm->second, 4 * i)); };
  // White comes first there, and last in an attribute.
  attributes["chromaticities"] =
      std::vector<float>{value(2), value(3), value(4), value(5), value(6), value(7), value(0), value(1)};
  return attributes;
}

// An entry iTXt is keyword, 0, two flags, of which the first is 0 where the text is not compressed, a language, 0, the
// translated keyword, 0, and the text.
std::string png_text(std::string_view content, std::string_view keyword) {
  std::string text;
  for_chunks(content, [&](std::string_view type, std::string_view data) {
    if (!data.starts_with(keyword) || data.substr(keyword.size()).substr(0, 1) != std::string_view("\0", 1))
      return true;
    std::string_view rest = data.substr(keyword.size() + 1);
    if (type == "tEXt") text = rest;
    if (type != "iTXt" || rest.size() < 2 || rest[0] != 0) return type != "tEXt";
    rest.remove_prefix(2);
    for (int i = 0; i < 2; ++i) {
      const std::size_t end = rest.find('\0');
      if (end == std::string_view::npos) return true;
      rest.remove_prefix(end + 1);
    }
    text = rest;
    return false;
  });
  return text;
}

}  // namespace goniochrome::image
