// OpenEXR on a page: the header is read here, and scanLines() of opening.js unpacks the pixels. The layout is that of
// "OpenEXR File Layout", openexr.com.
#include <Imath/half.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

#include "base/text.h"
#include "image/internal/exr.h"
#include "image/internal/exr_header.h"
#include "image/internal/exr_layers.h"
#include "platform.h"

namespace goniochrome::studio {

namespace {

enum ChannelType { kWhole, kHalf, kFloat };

struct ExrHeader {
  image::Attributes attributes;
  image::ExrPartNames names;
  std::vector<ChannelType> types;
  image::ExrWindow data, display;
  std::size_t packing = 0;
  std::string subsampled;  // the first such channel
};

template <class T>
T number_at(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

image::ExrWindow window_at(const char* bytes) {
  const auto edge = [&](int i) { return number_at<std::int32_t>(bytes + 4 * i); };
  const auto size = [](std::int64_t low, std::int64_t high) {
    return static_cast<int>(std::clamp<std::int64_t>(high - low + 1, 0, std::numeric_limits<int>::max()));
  };
  return {edge(0), edge(1), size(edge(0), edge(2)), size(edge(1), edge(3))};
}

// A channel is a name, its type, four bytes about its use, and its steps in x and y.
void take_channels(const char* bytes, ExrHeader& header) {
  while (*bytes != 0) {
    const std::string name = bytes;
    bytes += name.size() + 1;
    header.names.channels.push_back(name);
    header.types.push_back(static_cast<ChannelType>(number_at<std::int32_t>(bytes)));
    const bool is_full = number_at<std::int32_t>(bytes + 8) == 1 && number_at<std::int32_t>(bytes + 12) == 1;
    if (!is_full && header.subsampled.empty()) header.subsampled = name;
    bytes += 16;
  }
}

// The header of a file for which is_sound_exr_header() holds.
ExrHeader header_of(const std::string& content) {
  ExrHeader header;
  for (const char* at = content.data() + 8; *at != 0;) {
    const std::string name = at, type = at + name.size() + 1;
    at += name.size() + type.size() + 2;
    const auto size = number_at<std::uint32_t>(at);
    const char* value = at + 4;
    at = value + size;
    if (name == "channels" && type == "chlist") take_channels(value, header);
    if (name == "dataWindow" && type == "box2i") header.data = window_at(value);
    if (name == "displayWindow" && type == "box2i") header.display = window_at(value);
    if (name == "compression" && type == "compression") header.packing = static_cast<unsigned char>(*value);
    if (type == "string") header.attributes[name] = std::string(value, size);
    if (type == "envmap") header.attributes[name] = std::string(*value == 1 ? "cube" : "latlong");
    if (type == "chromaticities") {
      std::vector<float> xy(8);
      std::memcpy(xy.data(), value, 32);
      header.attributes[name] = std::move(xy);
    }
  }
  return header;
}

}  // namespace

Result<image::ImagePart> decoded_exr(const std::string& content, const std::string& name) {
  constexpr std::array kPackings = {"none", "RLE", "ZIPS", "ZIP", "PIZ", "PXR24", "B44", "B44A", "DWAA", "DWAB"};
  constexpr std::size_t kLastPacking = 3, kMostPixels = std::size_t{1} << 26;
  if (!image::is_sound_exr_header(content)) return input_error("{}: its header is damaged or cut off", name);
  const auto kind = static_cast<unsigned char>(content[5]);
  const ExrHeader header = header_of(content);
  const char* other = (kind & 0x10) != 0                             ? "several parts"
                      : (kind & 0x08) != 0                           ? "deep data"
                      : (kind & 0x02) != 0                           ? "tiles"
                      : header.packing >= kPackings.size()           ? "an unknown compression"
                      : header.packing > kLastPacking                ? kPackings[header.packing]
                      : !header.subsampled.empty()                   ? "subsampled channels"
                      : std::ranges::count(header.types, kWhole) > 0 ? "whole numbers"
                                                                     : nullptr;
  if (other != nullptr)
    return input_error(
        "{}: is OpenEXR with {}, which a page does not read: save it as one part of scan lines in half or float with "
        "ZIP compression, or as Radiance HDR (.hdr)",
        name, other);
  GONIO_ASSIGN(const image::ExrLayer layer, image::color_layer({header.names}, "", name));
  const auto width = static_cast<std::size_t>(header.data.width), height = static_cast<std::size_t>(header.data.height);
  std::vector<std::size_t> offsets(layer.channels.size());
  std::vector<ChannelType> types(layer.channels.size());
  std::size_t line_bytes = 0;
  for (std::size_t i = 0; i < header.types.size(); ++i) {
    const auto wanted = std::ranges::find(layer.channels, header.names.channels[i]);
    if (const auto at = static_cast<std::size_t>(wanted - layer.channels.begin()); at < offsets.size())
      offsets[at] = line_bytes, types[at] = header.types[i];
    line_bytes += width * (header.types[i] == kHalf ? 2 : 4);
  }
  const auto lines = given_files().find(name + kLines);
  if (width == 0 || height == 0 || lines == given_files().end() || lines->second.size() / height != line_bytes)
    return input_error("{}: is cut off, or its pixels are damaged: fetch it again", name);
  const image::ExrWindow& display = header.display;
  if (static_cast<std::size_t>(display.width) * static_cast<std::size_t>(display.height) >
      std::max(kMostPixels, 64 * width * height))
    return input_error("{}: its display window is too large for its {} x {} pixels: crop it", name, width, height);
  image::ImagePart part;
  part.attributes = header.attributes;
  const std::size_t channels = layer.channels.size();
  part.image = {header.data.width, header.data.height, static_cast<int>(channels),
                std::vector<float>(width * height * channels), layer.as};
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t c = 0; c < channels; ++c) {
      const char* from = lines->second.data() + y * line_bytes + offsets[c];
      float* to = part.image.pixel(0, static_cast<int>(y)) + c;
      for (std::size_t x = 0; x < width; ++x)
        to[x * channels] = types[c] == kHalf ? static_cast<float>(number_at<Imath::half>(from + 2 * x))
                                             : number_at<float>(from + 4 * x);
    }
  part.image = image::shown_in(display, header.data, std::move(part.image));
  return part;
}

}  // namespace goniochrome::studio
