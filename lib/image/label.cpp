#include "image/label.h"

#include <algorithm>
#include <cstdint>

namespace goniochrome::image {

namespace {

// 5 x 7 dots, rows from the top, the leftmost dot of a row in the highest of its five bits.
struct Glyph {
  char letter;
  std::uint64_t dots;
};
constexpr int kWide = 5, kHigh = 7;
// clang-format off
constexpr Glyph kGlyphs[] = {
    {'#', 0x295F57D4A},
    {'%', 0x674222173},
    {'(', 0x088842082},
    {')', 0x208210888},
    {'*', 0x02AEFBAA0},
    {'+', 0x0084F9080},
    {',', 0x000003088},
    {'-', 0x0000F8000},
    {'.', 0x00000018C},
    {'/', 0x042222210},
    {'0', 0x3A33AE62E},
    {'1', 0x11842108E},
    {'2', 0x3A213221F},
    {'3', 0x78217043E},
    {'4', 0x08CA97C42},
    {'5', 0x7E1E0862E},
    {'6', 0x1910F462E},
    {'7', 0x7C2222108},
    {'8', 0x3A317462E},
    {'9', 0x3A317844C},
    {':', 0x018C03180},
    {'<', 0x088882082},
    {'=', 0x001F07C00},
    {'>', 0x208208888},
    {'A', 0x3A31FC631},
    {'B', 0x7A31F463E},
    {'C', 0x3A308422E},
    {'D', 0x7A318C63E},
    {'E', 0x7E10F421F},
    {'F', 0x7E10F4210},
    {'G', 0x3A30BC62F},
    {'H', 0x4631FC631},
    {'I', 0x38842108E},
    {'J', 0x1C4210A4C},
    {'K', 0x4654C5251},
    {'L', 0x42108421F},
    {'M', 0x4775AC631},
    {'N', 0x47359C631},
    {'O', 0x3A318C62E},
    {'P', 0x7A31F4210},
    {'Q', 0x3A318D64D},
    {'R', 0x7A31F5251},
    {'S', 0x3E107043E},
    {'T', 0x7C8421084},
    {'U', 0x46318C62E},
    {'V', 0x46318C544},
    {'W', 0x4631AD771},
    {'X', 0x462A22A31},
    {'Y', 0x462A21084},
    {'Z', 0x7C222221F},
    {'_', 0x00000001F},
    {'|', 0x108421084},
};
// clang-format on
constexpr std::uint64_t kUnknown = 0x7F1FFFFFF;  // nearly full: a letter that is not here is seen to be missing

std::uint64_t dots_of(char letter) {
  if (letter == ' ') return 0;
  const char capital = letter >= 'a' && letter <= 'z' ? static_cast<char>(letter - 'a' + 'A') : letter;
  const auto* glyph = std::ranges::find(kGlyphs, capital, &Glyph::letter);
  return glyph == std::end(kGlyphs) ? kUnknown : glyph->dots;
}

}  // namespace

int label_width(const std::string& text, int scale) {
  return static_cast<int>(text.size()) * (kWide + 1) * scale;
}

int label_height(int scale) {
  return kHigh * scale;
}

void fill_box(Image& image, int x, int y, int width, int height, const std::array<float, 3>& color) {
  for (int j = std::max(0, y); j < std::min(image.height, y + height); ++j)
    for (int i = std::max(0, x); i < std::min(image.width, x + width); ++i)
      std::copy_n(color.begin(), std::min(3, image.channels), image.pixel(i, j));
}

void draw_label(Image& image, int x, int y, const std::string& text, int scale, const std::array<float, 3>& color) {
  for (const char letter : text) {
    const std::uint64_t dots = dots_of(letter);
    for (int row = 0; row < kHigh; ++row)
      for (int column = 0; column < kWide; ++column)
        if (dots >> (kWide * (kHigh - row) - 1 - column) & 1)
          fill_box(image, x + column * scale, y + row * scale, scale, scale, color);
    x += (kWide + 1) * scale;
  }
}

}  // namespace goniochrome::image
