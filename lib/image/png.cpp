#include <png.h>

#include <algorithm>
#include <cmath>
#include <csetjmp>
#include <cstdint>

#include "base/file.h"
#include "base/text.h"
#include "image/image.h"

namespace goniochrome::image {

namespace {

std::string spelled(const AttributeValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* number = std::get_if<float>(&value)) return shortest(*number);
  if (const auto* whole = std::get_if<int>(&value)) return std::to_string(*whole);
  std::string list;
  for (const float number : std::get<std::vector<float>>(value)) {
    if (!list.empty()) list += ' ';
    list += shortest(number);
  }
  return list;
}

std::vector<std::uint8_t> rgb_bytes(const Image& image) {
  const std::size_t pixels = static_cast<std::size_t>(image.width) * image.height;
  std::vector<std::uint8_t> bytes(pixels * 3);
  for (std::size_t i = 0; i < pixels; ++i)
    for (int c = 0; c < 3; ++c) {
      const float value = image.data[i * image.channels + (image.channels < 3 ? 0 : c)];
      // A NaN is black.
      bytes[i * 3 + c] =
          static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(value > 0 ? value : 0.0F, 0.0F, 1.0F)));
    }
  return bytes;
}

void append(png_structp png, png_bytep bytes, png_size_t count) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(bytes), count);
}

// libpng reports errors by longjmp, so no object with a destructor is made between setjmp and the end.
bool encode(png_structp png, png_infop info, const Image& image, const std::uint8_t* bytes,
            const std::vector<png_text>& entries) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_set_IHDR(png, info, static_cast<png_uint_32>(image.width), static_cast<png_uint_32>(image.height), 8,
               PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  if (!entries.empty()) png_set_text(png, info, entries.data(), static_cast<int>(entries.size()));
  png_write_info(png, info);
  for (int y = 0; y < image.height; ++y) png_write_row(png, bytes + static_cast<std::size_t>(y) * image.width * 3);
  png_write_end(png, info);
  return true;
}

}  // namespace

Result<std::string> png_content(const std::string& name, const Image& image, const Attributes& text) {
  const std::vector<std::uint8_t> bytes = rgb_bytes(image);
  std::vector<std::string> words;
  words.reserve(text.size());
  std::vector<png_text> entries;
  for (const auto& [key, value] : text) {
    words.push_back(spelled(value));
    png_text entry = {};
    entry.compression = PNG_TEXT_COMPRESSION_NONE;
    entry.key = const_cast<char*>(key.c_str());
    entry.text = words.back().data();
    entry.text_length = words.back().size();
    entries.push_back(entry);
  }
  std::string file;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  if (info) png_set_write_fn(png, &file, append, nullptr);
  const bool done = info && encode(png, info, image, bytes.data(), entries);
  png_destroy_write_struct(&png, &info);
  if (!done) return input_error("{}: cannot be encoded as PNG", name);
  return file;
}

Result<void> write_png(const std::string& path, const Image& image, const Attributes& text) {
  GONIO_ASSIGN(const std::string file, png_content(path, image, text));
  return write_file(path, file);
}

}  // namespace goniochrome::image
