#include "image/sheet.h"

#include <algorithm>

#include "image/label.h"

namespace goniochrome::image {

namespace {

// Display values: the gray of the backdrop of pictures (18 %, as sRGB), and light letters on a darker strip.
constexpr float kBackdrop = 0.46F, kStrip = 0.2F, kLetters = 0.92F;

// How many characters a label of the usual length has, which its cell should have room for.
constexpr int kUsualCharacters = 26, kCharacterDots = 6;

}  // namespace

std::string fitted_label(const std::string& text, int scale, int width) {
  std::string label;
  for (const char byte : text) {
    const auto value = static_cast<unsigned char>(byte);
    if (value >= 0x80 && value < 0xC0) continue;  // goes on with the character before
    label += value >= 0x80 || value < 0x20 ? '\x7F' : byte;
  }
  const auto most = static_cast<std::size_t>(std::max(0, width / (kCharacterDots * scale)));
  if (label.size() > most)
    label = label.substr(0, most > 2 ? most - 2 : 0) + std::string(std::min<std::size_t>(most, 2), '.');
  return label;
}

ContactSheet::ContactSheet(int columns, int rows, int picture_width, int picture_height)
    : columns_(columns),
      rows_(rows),
      width_(picture_width),
      height_(picture_height),
      scale_(std::clamp(picture_width / (kUsualCharacters * kCharacterDots), 1, 8)),
      gap_(2 * scale_),
      strip_(label_height(scale_) + 4 * scale_) {
  picture_.width = columns_ * (width_ + gap_) + gap_;
  picture_.height = rows_ * (height_ + strip_ + gap_) + gap_;
  const auto pixels = static_cast<std::size_t>(picture_.width) * static_cast<std::size_t>(picture_.height);
  picture_.rgb.assign(3 * pixels, static_cast<std::uint8_t>(255 * kBackdrop));
}

void ContactSheet::put(int cell, const ByteImage* picture, const std::string& label) {
  const int left = gap_ + cell % columns_ * (width_ + gap_);
  const int top = gap_ + cell / columns_ * (height_ + strip_ + gap_);
  for (int y = 0; picture != nullptr && y < std::min(height_, picture->height); ++y)
    std::copy_n(picture->pixel(0, y), 3 * static_cast<std::size_t>(std::min(width_, picture->width)),
                picture_.pixel(left, top + y));
  Image strip = even_image(width_, strip_, 3, {}, kStrip);
  const std::string text = fitted_label(label, scale_, width_ - 4 * scale_);
  draw_label(strip, 2 * scale_, 2 * scale_, text, scale_, {kLetters, kLetters, kLetters});
  const ByteImage bytes = byte_image(strip);
  for (int y = 0; y < strip_; ++y)
    std::copy_n(bytes.pixel(0, y), 3 * static_cast<std::size_t>(width_), picture_.pixel(left, top + height_ + y));
}

SheetPlace SheetPlaces::begin_sheet(int cell) {
  if (is_begun_) ++sheet_;
  is_begun_ = true, used_ = 1;
  return {sheet_, cell};
}

SheetPlace SheetPlaces::next(const std::string& name, const std::string& follower) {
  const int middle = cells_ / 2;
  if (!leader_.empty() && name.starts_with(leader_ + ".") && used_ < cells_) {
    const int number = used_++ - 1;  // among the followers
    return {sheet_, number < middle ? number : number + 1};
  }
  const bool had_leader = !leader_.empty();
  leader_ = in_middle_ && !name.empty() && follower.starts_with(name + ".") ? name : "";
  if (!leader_.empty()) return begin_sheet(middle);
  if (!is_begun_ || had_leader || used_ == cells_) return begin_sheet(0);
  return {sheet_, used_++};
}

}  // namespace goniochrome::image
