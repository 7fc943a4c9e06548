#include "envmap/engine_cube.h"

#include <Imath/half.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <map>

#include "base/file.h"
#include "base/text.h"
#include "color/color.h"

namespace goniochrome::envmap {

namespace {

constexpr std::size_t kFaces = 6, kChannels = 4;

// The low `bytes` bytes of a number, the lowest first.
void put(std::string& out, std::uint64_t number, int bytes) {
  for (int i = 0; i < bytes; ++i) out += static_cast<char>(number >> 8 * i & 0xFF);
}

void put_all(std::string& out, const std::vector<std::uint32_t>& numbers) {
  for (const std::uint32_t number : numbers) put(out, number, 4);
}

void pad(std::string& out, std::size_t alignment) {
  out.resize((out.size() + alignment - 1) / alignment * alignment, '\0');
}

// How every level of a file is stored.
struct Storage {
  bool as_float = false;
  int channel_bytes() const { return as_float ? 4 : 2; }
  std::size_t texel_bytes() const { return kChannels * static_cast<std::size_t>(channel_bytes()); }
};

Storage storage_of(const std::vector<PrefilteredLobe>& levels) {
  return {
      std::ranges::any_of(levels, [](const auto& level) { return storage_type(level) == image::PixelType::kFloat; })};
}

// Appends one face of a level.
void put_face(std::string& out, const CubeMap& map, std::size_t face, const Storage& storage) {
  const std::size_t texels = static_cast<std::size_t>(map.size) * map.size;
  const float* rgb = map.texels.data() + 3 * texels * face;
  const auto put_value = [&](float value) {
    if (storage.as_float)
      put(out, std::bit_cast<std::uint32_t>(value), 4);
    else
      put(out, Imath::half(value).bits(), 2);
  };
  for (std::size_t i = 0; i < texels; ++i) {
    for (std::size_t c = 0; c < 3; ++c) put_value(rgb[3 * i + c]);
    put_value(1);
  }
}

// One line of numbers, level by level.
template <class Number>
std::string line_of(const std::vector<PrefilteredLobe>& levels, const Number& number) {
  std::string text;
  for (const PrefilteredLobe& level : levels) text += (text.empty() ? "" : " ") + shortest(number(level));
  return text;
}

// The basic data format descriptor of KTX 2.0 [KhronosDataFormat 5.2]: linear RGBA of signed floats with the primaries
// of BT.709.
std::string data_format(const Storage& storage) {
  constexpr std::uint32_t kVersion = 2, kModelRgbsda = 1, kPrimariesBt709 = 1, kTransferLinear = 1;
  constexpr std::uint32_t kSignedFloat = 0xC0, kMinusOne = 0xBF800000, kOne = 0x3F800000;
  constexpr std::array<std::uint32_t, kChannels> kChannelIds = {0, 1, 2, 15};
  constexpr std::uint32_t kBlockBytes = 24 + 16 * kChannels;
  const auto bits = static_cast<std::uint32_t>(8 * storage.channel_bytes());
  std::string out;
  put_all(out, {4 + kBlockBytes, 0, kVersion | kBlockBytes << 16,
                kModelRgbsda | kPrimariesBt709 << 8 | kTransferLinear << 16, 0,
                static_cast<std::uint32_t>(storage.texel_bytes()), 0});
  for (std::uint32_t c = 0; c < kChannels; ++c)
    put_all(out, {c * bits | (bits - 1) << 16 | (kSignedFloat | kChannelIds[c]) << 24, 0, kMinusOne, kOne});
  return out;
}

// The keys and values of KTX 2.0, in the order of their keys.
std::string key_values(const std::map<std::string, std::string>& values) {
  std::string out;
  for (const auto& [key, value] : values) {
    const std::string pair = key + '\0' + value + '\0';
    put(out, pair.size(), 4);
    out += pair;
    pad(out, 4);
  }
  return out;
}

}  // namespace

Rec709Levels in_rec709(std::vector<PrefilteredLobe> levels) {
  Rec709Levels result;
  for (PrefilteredLobe& level : levels) {
    std::vector<float>& texels = level.map.texels;
    for (std::size_t i = 0; i < texels.size(); i += 3) {
      const color::Rgb rgb = color::rec709_from_rec2020({texels[i], texels[i + 1], texels[i + 2]});
      // Gray stays gray but for the rounding of the two matrices.
      const double rounding = -1e-6 * std::max({rgb[0], rgb[1], rgb[2]});
      result.clipped += std::min({rgb[0], rgb[1], rgb[2]}) < rounding;
      for (std::size_t c = 0; c < 3; ++c) texels[i + c] = static_cast<float>(std::max(rgb[c], 0.0));
    }
  }
  result.levels = std::move(levels);
  return result;
}

// KTX 2.0, section 3: header, index of levels, data format, keys and values, and then the levels with the smallest
// first, each at a multiple of its texel's size.
Result<void> write_ktx2(const std::string& path, const std::vector<PrefilteredLobe>& levels, const std::string& source,
                        const std::string& command) {
  constexpr std::uint32_t kHalves = 97, kFloats = 109;  // VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT
  const Storage storage = storage_of(levels);
  const auto size = static_cast<std::uint32_t>(levels.front().map.size);
  const auto count = static_cast<std::uint32_t>(levels.size());
  const std::string format = data_format(storage);
  const std::string pairs = key_values(
      {{"KTXorientation", "rd"},
       {"KTXwriter", "goniochrome"},
       {"goniochrome:command", command},
       {"goniochrome:exponents", line_of(levels, [](const PrefilteredLobe& level) { return level.exponent; })},
       {"goniochrome:lookupErrors", line_of(levels, [](const PrefilteredLobe& level) { return level.lookup_error; })},
       {"goniochrome:maxErrors", line_of(levels, [](const PrefilteredLobe& level) { return level.max_error; })},
       {"goniochrome:source", source},
       {"goniochrome:tolerance", shortest(levels.front().tolerance)}});

  std::string out = "\xABKTX 20\xBB\r\n\x1A\n";
  put_all(out, {storage.as_float ? kFloats : kHalves, static_cast<std::uint32_t>(storage.channel_bytes()), size, size,
                0, 0, kFaces, count, 0});
  const std::size_t format_at = out.size() + 32 + 24 * levels.size(), pairs_at = format_at + format.size();
  put_all(out, {static_cast<std::uint32_t>(format_at), static_cast<std::uint32_t>(format.size()),
                static_cast<std::uint32_t>(pairs_at), static_cast<std::uint32_t>(pairs.size()), 0, 0, 0, 0});

  const std::size_t texel = storage.texel_bytes(), end_of_pairs = pairs_at + pairs.size();
  std::vector<std::size_t> at(levels.size()), bytes(levels.size());
  std::size_t next = (end_of_pairs + texel - 1) / texel * texel;
  for (std::size_t level = levels.size(); level-- > 0;) {
    const auto n = static_cast<std::size_t>(levels[level].map.size);
    at[level] = next, bytes[level] = kFaces * n * n * texel;
    next += bytes[level];
  }
  for (std::size_t level = 0; level < levels.size(); ++level)
    put(out, at[level], 8), put(out, bytes[level], 8), put(out, bytes[level], 8);
  out += format + pairs;
  out.reserve(next);
  pad(out, texel);
  for (std::size_t level = levels.size(); level-- > 0;)
    for (std::size_t face = 0; face < kFaces; ++face) put_face(out, levels[level].map, face, storage);
  return write_file(path, out);
}

// "DDS ", a header of 124 bytes, and then face by face all levels of it.
Result<void> write_dds(const std::string& path, const std::vector<PrefilteredLobe>& levels) {
  constexpr std::uint32_t kHalves = 113, kFloats = 116;  // D3DFMT_A16B16G16R16F, D3DFMT_A32B32G32R32F
  constexpr std::uint32_t kCapsHeightWidthPitchFormatMips = 0x2100F, kFourCode = 4;
  constexpr std::uint32_t kComplexTextureMips = 0x401008, kCubeOfAllFaces = 0xFE00;
  const Storage storage = storage_of(levels);
  const auto size = static_cast<std::uint32_t>(levels.front().map.size);
  std::string out = "DDS ";
  put_all(out,
          {124, kCapsHeightWidthPitchFormatMips, size, size, static_cast<std::uint32_t>(size * storage.texel_bytes()),
           0, static_cast<std::uint32_t>(levels.size())});
  put_all(out, std::vector<std::uint32_t>(11));
  put_all(out, {32, kFourCode, storage.as_float ? kFloats : kHalves, 0, 0, 0, 0, 0});
  put_all(out, {kComplexTextureMips, kCubeOfAllFaces, 0, 0, 0});
  for (std::size_t face = 0; face < kFaces; ++face)
    for (const PrefilteredLobe& level : levels) put_face(out, level.map, face, storage);
  return write_file(path, out);
}

}  // namespace goniochrome::envmap
