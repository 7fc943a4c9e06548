#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "base/file.h"
#include "base/parallel.h"
#include "base/text.h"
#include "image/byte_image.h"
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

std::string big_endian(std::uint32_t value) {
  std::string bytes;
  for (const int shift : {24, 16, 8, 0}) bytes += static_cast<char>(value >> shift & 0xFF);
  return bytes;
}

const Bytef* bytes_of(const std::string& text) {
  return reinterpret_cast<const Bytef*>(text.data());
}

// A chunk of a PNG: its length, its type, its data, and the check of both.
void append_chunk(const char* type, const std::string& data, std::string& file) {
  uLong check = crc32(crc32(0, nullptr, 0), reinterpret_cast<const Bytef*>(type), 4);
  check = crc32(check, bytes_of(data), static_cast<uInt>(data.size()));
  file += big_endian(static_cast<std::uint32_t>(data.size())) + std::string(type, 4) + data +
          big_endian(static_cast<std::uint32_t>(check));
}

// A text entry: Latin-1 by the format's first kind of entries, of which ASCII is a part, else UTF-8 by its third.
void append_text(const std::string& key, const std::string& text, std::string& file) {
  const bool ascii = std::ranges::all_of(text, [](char c) { return static_cast<unsigned char>(c) < 0x80; });
  std::string data = key + '\0';
  if (!ascii) data += std::string(4, '\0');  // not compressed, no language, no translated key
  append_chunk(ascii ? "tEXt" : "iTXt", data + text, file);
}

// The chunk sRGB, whose byte asks for colors as they are, or cICP: primaries, curve, no matrix, the full range.
// [Portable Network Graphics (Third Edition), 11.3.2]
void append_signal(const std::optional<SignalCode>& signal, std::string& file) {
  if (!signal) return;
  if (*signal == SignalCode{}) return append_chunk("sRGB", "\x01", file);
  append_chunk("cICP", {static_cast<char>(signal->primaries), static_cast<char>(signal->transfer), 0, 1}, file);
}

constexpr std::size_t kBandBytes = std::size_t{1} << 18;  // of rows that are compressed by one core
constexpr std::uint8_t kSub = 1;                          // each byte is stored as what it adds to its left neighbor

// Rows [begin, end) of the picture as the filter leaves them, each after the filter's number.
std::vector<std::uint8_t> filtered_rows(const ByteImage& image, int begin, int end) {
  const std::size_t row_bytes = 3 * static_cast<std::size_t>(image.width);
  std::vector<std::uint8_t> rows((row_bytes + 1) * static_cast<std::size_t>(end - begin));
  std::uint8_t* to = rows.data();
  for (int y = begin; y < end; ++y) {
    const std::uint8_t* from = image.pixel(0, y);
    *to++ = kSub;
    std::copy_n(from, 3, to);
    for (std::size_t i = 3; i < row_bytes; ++i) to[i] = static_cast<std::uint8_t>(from[i] - from[i - 3]);
    to += row_bytes;
  }
  return rows;
}

struct Band {
  std::string compressed;
  uLong check = 1;
  std::size_t bytes = 0;
};

// Runs of equal differences are what is worth finding in a shaded picture. On thumbnails and pictures of a car, finding
// them alone takes a quarter to a fifth of the time of zlib's usual search and of the choice of a filter for each row,
// and gives files that are larger by 4 to 10 %.
Band compressed_band(const ByteImage& image, int begin, int end, bool last) {
  std::vector<std::uint8_t> rows = filtered_rows(image, begin, end);
  Band band;
  band.bytes = rows.size();
  band.check = adler32(1, rows.data(), static_cast<uInt>(rows.size()));
  z_stream stream = {};
  constexpr int kRaw = -15, kMemory = 9;
  deflateInit2(&stream, 1, Z_DEFLATED, kRaw, kMemory, Z_RLE);
  band.compressed.resize(deflateBound(&stream, rows.size()) + 16);  // and what a flush adds
  stream.next_in = rows.data(), stream.avail_in = static_cast<uInt>(rows.size());
  stream.next_out = reinterpret_cast<Bytef*>(band.compressed.data());
  stream.avail_out = static_cast<uInt>(band.compressed.size());
  deflate(&stream, last ? Z_FINISH : Z_SYNC_FLUSH);
  band.compressed.resize(stream.total_out);
  deflateEnd(&stream);
  return band;
}

// The picture as one zlib stream. Its bands are compressed by themselves and put one behind the other, which the format
// allows where each but the last ends with a flush.
std::string compressed(const ByteImage& image) {
  const std::size_t row_bytes = 3 * static_cast<std::size_t>(image.width) + 1;
  const int rows_each = static_cast<int>(std::max<std::size_t>(1, kBandBytes / row_bytes));
  const int count = std::max(1, (image.height + rows_each - 1) / rows_each);
  std::vector<Band> bands(static_cast<std::size_t>(count));
  parallel_for(bands.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const int first = static_cast<int>(i) * rows_each;
      bands[i] = compressed_band(image, first, std::min(image.height, first + rows_each), i + 1 == bands.size());
    }
  });
  std::string stream = "\x78\x01";  // deflate, a window of 32 kB, the fastest level
  uLong check = 1;
  for (const Band& band : bands) {
    stream += band.compressed;
    check = adler32_combine(check, band.check, static_cast<z_off_t>(band.bytes));
  }
  return stream + big_endian(static_cast<std::uint32_t>(check));
}

// round(255 v) of a value in 0..1; what is below, or a NaN, is 0.
std::uint8_t byte_of(float value) {
  const float inside = value > 0 ? std::min(value, 1.0F) : 0.0F;
  return static_cast<std::uint8_t>(std::lround(255.0F * inside));
}

}  // namespace

void put_bytes(const Image& image, ByteImage& bytes) {
  const std::size_t pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  const auto channels = static_cast<std::size_t>(image.channels);
  bytes.width = image.width, bytes.height = image.height;
  bytes.rgb.resize(3 * pixels);
  parallel_for(pixels, std::size_t{1} << 15, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t c = 0; c < 3; ++c)
        bytes.rgb[3 * i + c] = byte_of(image.data[i * channels + (channels < 3 ? 0 : c)]);
  });
}

ByteImage byte_image(const Image& image) {
  ByteImage bytes;
  put_bytes(image, bytes);
  return bytes;
}

std::string png_content(const ByteImage& image, const Attributes& text) {
  std::string file = "\x89PNG\r\n\x1a\n";
  const std::string eight_bits_rgb("\x08\x02\x00\x00\x00", 5);
  append_chunk("IHDR",
               big_endian(static_cast<std::uint32_t>(image.width)) +
                   big_endian(static_cast<std::uint32_t>(image.height)) + eight_bits_rgb,
               file);
  append_signal(image.signal, file);
  for (const auto& [key, value] : text) append_text(key, spelled(value), file);
  append_chunk("IDAT", compressed(image), file);
  append_chunk("IEND", "", file);
  return file;
}

Result<std::string> png_content(const std::string& name, const Image& image, const Attributes& text) {
  if (image.width < 1 || image.height < 1 || image.channels < 1)
    return input_error("{}: cannot be encoded as PNG: there are no pixels", name);
  if (auto finite = check_finite(image); !finite.ok()) return input_error("{}: {}", name, finite.error().message);
  return png_content(byte_image(image), text);
}

Result<void> write_png(const std::string& path, const Image& image, const Attributes& text) {
  GONIO_ASSIGN(const std::string file, png_content(path, image, text));
  return write_file(path, file);
}

}  // namespace goniochrome::image
