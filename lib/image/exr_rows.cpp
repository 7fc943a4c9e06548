#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <libdeflate.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <vector>

#include "base/parallel.h"
#include "base/unset_array.h"
#include "image/internal/exr_rows.h"

namespace goniochrome::image {

namespace {

// The scan lines of a block; 0 of a way of packing that is not decoded here.
int lines_of_block(Imf::Compression compression) {
  switch (compression) {
    case Imf::NO_COMPRESSION:
    case Imf::ZIPS_COMPRESSION:
      return 1;
    case Imf::ZIP_COMPRESSION:
      return 16;
    default:
      return 0;
  }
}

// A channel that is wanted, in a scan line, which holds one channel behind the other.
struct Channel {
  std::size_t offset = 0;  // of its first byte
  bool is_half = false;
};

struct Layout {
  std::vector<Channel> channels;
  std::size_t line_bytes = 0;
};

Layout layout_of(const Imf::ChannelList& list, const Image& image) {
  Layout layout;
  layout.channels.resize(image.channel_names.size());
  for (auto it = list.begin(); it != list.end(); ++it) {
    const bool is_half = it.channel().type == Imf::HALF;
    const auto wanted = std::ranges::find(image.channel_names, it.name());
    if (wanted != image.channel_names.end())
      layout.channels[static_cast<std::size_t>(wanted - image.channel_names.begin())] = {layout.line_bytes, is_half};
    layout.line_bytes += (is_half ? 2 : 4) * static_cast<std::size_t>(image.width);
  }
  return layout;
}

// A half as a float. The exponents of both differ by 112; a product has the rounding of subnormal numbers right, and
// what is not finite takes the largest exponent.
float float_of_half(std::uint32_t half) {
  const std::uint32_t sign = (half & 0x8000) << 16, magnitude = half & 0x7fff;
  const float scaled = std::bit_cast<float>(magnitude << 13) * 0x1p112F;
  const std::uint32_t special = magnitude >= 0x7c00 ? 0x7f800000 | magnitude << 13 : 0;
  return std::bit_cast<float>(sign | std::bit_cast<std::uint32_t>(scaled) | special);
}

// The bytes of a block at even places, and those at odd ones. Zip parts them; else both lie in one array.
struct SplitBytes {
  const std::uint8_t *even, *odd;
};

// The bytes of a kind are `kStep` apart.
template <std::size_t kStep>
void put_channel(const SplitBytes& bytes, const Channel& channel, std::size_t first_byte, std::size_t width,
                 std::size_t channels, float* to) {
  const std::size_t first = (first_byte + channel.offset) / 2;
  const std::uint8_t *even = bytes.even + first * kStep, *odd = bytes.odd + first * kStep;
  const auto word = [&](std::size_t pair) {
    return static_cast<std::uint32_t>(even[pair * kStep] | odd[pair * kStep] << 8);
  };
  if (channel.is_half) {
    for (std::size_t x = 0; x < width; ++x) to[x * channels] = float_of_half(word(x));
  } else {
    for (std::size_t x = 0; x < width; ++x)
      to[x * channels] = std::bit_cast<float>(word(2 * x) | word(2 * x + 1) << 16);
  }
}

// Each byte that Zip packs is stored as what it adds to the one before, and 128.
void add_up(std::uint8_t* bytes, std::size_t count) {
  std::uint8_t sum = 128;
  for (std::size_t i = 0; i < count; ++i) bytes[i] = sum = static_cast<std::uint8_t>(sum + bytes[i] - 128);
}

// A block of scan lines as the file holds it.
struct Block {
  std::size_t begin = 0, size = 0;  // of its bytes
  int first_line = 0, lines = 0;    // of the picture
};

template <std::size_t kStep>
void put_lines(const SplitBytes& bytes, const Block& block, const Layout& layout, Image& image) {
  for (int line = 0; line < block.lines; ++line) {
    float* to = image.pixel(0, block.first_line + line);
    for (std::size_t c = 0; c < layout.channels.size(); ++c)
      put_channel<kStep>(bytes, layout.channels[c], layout.line_bytes * static_cast<std::size_t>(line),
                         static_cast<std::size_t>(image.width), layout.channels.size(), to + c);
  }
}

// The memory that a thread unpacks blocks in.
struct Room {
  std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)> unpacker{
      libdeflate_alloc_decompressor(), libdeflate_free_decompressor};
  UnsetArray<std::uint8_t> bytes;
};

// A block that packing does not make smaller is stored as it is.
void decode(const std::uint8_t* packed, const Block& block, const Layout& layout, Room& room, Image& image) {
  const std::size_t count = layout.line_bytes * static_cast<std::size_t>(block.lines);
  if (block.size == count) return put_lines<2>({packed, packed + 1}, block, layout, image);
  if (room.unpacker == nullptr) throw std::bad_alloc();
  if (room.bytes.size() < count) room.bytes = UnsetArray<std::uint8_t>(count);
  std::uint8_t* bytes = room.bytes.data();
  if (block.size > count ||
      libdeflate_zlib_decompress(room.unpacker.get(), packed, block.size, bytes, count, nullptr) != LIBDEFLATE_SUCCESS)
    throw std::runtime_error("its packed pixels are damaged");
  add_up(bytes, count);
  put_lines<1>({bytes, bytes + count / 2}, block, layout, image);
}

}  // namespace

bool has_rows(const Imf::Header& header) {
  if (header.hasTileDescription() || (header.hasType() && header.type() != Imf::SCANLINEIMAGE)) return false;
  if (lines_of_block(header.compression()) == 0) return false;
  for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
    const Imf::Channel& channel = it.channel();
    if (channel.xSampling != 1 || channel.ySampling != 1) return false;
    if (channel.type != Imf::HALF && channel.type != Imf::FLOAT) return false;
  }
  return true;
}

void read_rows(Imf::MultiPartInputFile& file, int index, Image& image) {
  const Imf::Header& header = file.header(index);
  const Layout layout = layout_of(header.channels(), image);
  const int lines = lines_of_block(header.compression()), top = header.dataWindow().min.y;
  // The library finds the blocks, one after the other; they are small beside what they unpack to.
  Imf::InputPart input(file, index);
  std::vector<std::uint8_t> content;
  std::vector<Block> blocks;
  for (int line = 0; line < image.height; line += lines) {
    const char* bytes = nullptr;
    int size = 0;
    input.rawPixelData(top + line, bytes, size);
    blocks.push_back({content.size(), static_cast<std::size_t>(size), line, std::min(lines, image.height - line)});
    content.insert(content.end(), bytes, bytes + size);
  }
  constexpr std::size_t kBlockLines = 16;
  const std::size_t together = kBlockLines / static_cast<std::size_t>(lines);
  parallel_for(blocks.size(), together, [&](std::size_t begin, std::size_t end) {
    Room room;
    for (std::size_t i = begin; i < end; ++i) decode(content.data() + blocks[i].begin, blocks[i], layout, room, image);
  });
}

}  // namespace goniochrome::image
