#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfCompression.h>
#include <OpenEXR/ImfEnvmapAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <exception>
#include <new>
#include <stdexcept>

#include "base/file.h"
#include "base/parallel.h"
#include "image/internal/exr.h"

namespace goniochrome::image {

namespace {

// The most samples that a byte of a file can stand for. Deflate makes 1032 bytes of one; of the others, one color all
// over packs best: 8192 x 4096 halves take 31 (RLE), 145 (PIZ), 5 (B44A) and 7068 (DWAB) samples to a byte.
std::size_t most_samples_a_byte(Imf::Compression compression) {
  switch (compression) {
    case Imf::NO_COMPRESSION:
      return 1;
    case Imf::RLE_COMPRESSION:
      return 64;
    case Imf::B44_COMPRESSION:
    case Imf::B44A_COMPRESSION:
      return 16;
    case Imf::DWAA_COMPRESSION:
    case Imf::DWAB_COMPRESSION:
      return 16384;
    default:
      return 1032;
  }
}

// Whether every attribute of every header ends within the file: the library makes room for what an attribute says its
// length is before it reads it. A header is a list of name, type, length and value, ended by an empty name; so is the
// list of the headers of several parts (bit 12 of the version).
bool header_ends_within(const std::string& content) {
  if (content.size() < 8) return false;
  const bool several = (static_cast<unsigned char>(content[5]) & 0x10) != 0;
  std::size_t at = 8;
  const auto skip_text = [&] {
    at = content.find('\0', at);
    return at != std::string::npos && ++at < content.size();
  };
  do {
    while (at < content.size() && content[at] != '\0') {
      std::int32_t length = 0;
      if (!skip_text() || !skip_text() || content.size() - at < sizeof length) return false;
      std::memcpy(&length, content.data() + at, sizeof length);
      at += sizeof length;
      if (length < 0 || static_cast<std::size_t>(length) > content.size() - at) return false;
      at += static_cast<std::size_t>(length);
    }
    ++at;
  } while (several && at < content.size() && content[at] != '\0');
  return at < content.size();
}

class MemoryInput : public Imf::IStream {
 public:
  MemoryInput(const std::string& content, const std::string& name) : IStream(name.c_str()), content_(content) {}

  bool read(char bytes[], int count) override {
    if (count < 0 || content_.size() - position_ < static_cast<std::size_t>(count))
      throw std::runtime_error("the file is cut off");
    std::memcpy(bytes, content_.data() + position_, static_cast<std::size_t>(count));
    position_ += static_cast<std::size_t>(count);
    return position_ < content_.size();
  }
  std::uint64_t tellg() override { return position_; }
  void seekg(std::uint64_t position) override {
    if (position > content_.size()) throw std::runtime_error("the file is cut off");
    position_ = position;
  }

 private:
  const std::string& content_;
  std::size_t position_ = 0;
};

std::vector<float> xy_values(const Imf::Chromaticities& c) {
  return {c.red.x, c.red.y, c.green.x, c.green.y, c.blue.x, c.blue.y, c.white.x, c.white.y};
}

Attributes attributes_of(const Imf::Header& header) {
  Attributes attributes;
  for (auto it = header.begin(); it != header.end(); ++it) {
    const std::string name = it.name();
    if (name == "type" || name == "name") continue;
    const Imf::Attribute& value = it.attribute();
    if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&value))
      attributes[name] = text->value();
    else if (const auto* number = dynamic_cast<const Imf::FloatAttribute*>(&value))
      attributes[name] = number->value();
    else if (const auto* whole = dynamic_cast<const Imf::IntAttribute*>(&value))
      attributes[name] = whole->value();
    else if (const auto* xy = dynamic_cast<const Imf::ChromaticitiesAttribute*>(&value))
      attributes[name] = xy_values(xy->value());
    else if (const auto* map = dynamic_cast<const Imf::EnvmapAttribute*>(&value))
      attributes[name] = std::string(map->value() == Imf::ENVMAP_CUBE ? "cube" : "latlong");
  }
  return attributes;
}

// R G B A first, then the others in the file's order.
std::vector<std::string> ordered_channels(const Imf::ChannelList& list) {
  std::vector<std::string> names;
  for (const char* name : {"R", "G", "B", "A"})
    if (list.findChannel(name)) names.emplace_back(name);
  for (auto it = list.begin(); it != list.end(); ++it)
    if (std::find(names.begin(), names.end(), it.name()) == names.end()) names.emplace_back(it.name());
  return names;
}

Result<ImagePart> decoded_part(Imf::MultiPartInputFile& file, int index, const std::string& file_name,
                               std::size_t file_bytes) {
  const Imf::Header& header = file.header(index);
  ImagePart part;
  if (header.hasName()) part.name = header.name();
  const std::string where = part.name.empty() ? file_name : fmt::format("{}: part {}", file_name, part.name);
  if (header.hasType() && Imf::isDeepData(header.type()))
    return input_error("{}: holds deep data: flatten it first", where);
  if (!file.partComplete(index)) return input_error("{}: is cut off: some scan lines are missing", where);

  const Imath::Box2i& window = header.dataWindow();
  Image& image = part.image;
  image.width = window.max.x - window.min.x + 1;
  image.height = window.max.y - window.min.y + 1;
  image.channel_names = ordered_channels(header.channels());
  image.channels = static_cast<int>(image.channel_names.size());
  const std::size_t samples = static_cast<std::size_t>(image.width) * image.height * image.channels;
  if (samples == 0) return input_error("{}: holds no pixels", where);
  if (samples > kMostSamples || samples / most_samples_a_byte(header.compression()) > file_bytes)
    return input_error("{}: {} x {} pixels are too many for a file of {} bytes", where, image.width, image.height,
                       file_bytes);
  image.data.resize(samples);

  part.type = PixelType::kHalf;
  Imf::FrameBuffer buffer;
  const std::size_t x_stride = sizeof(float) * image.channels, y_stride = x_stride * image.width;
  for (int c = 0; c < image.channels; ++c) {
    const Imf::Channel& channel = header.channels()[image.channel_names[c].c_str()];
    if (channel.xSampling != 1 || channel.ySampling != 1)
      return input_error("{}: channel {} is subsampled: convert it to full resolution", where, image.channel_names[c]);
    if (channel.type != Imf::HALF) part.type = PixelType::kFloat;
    buffer.insert(image.channel_names[c],
                  Imf::Slice::Make(Imf::FLOAT, image.data.data() + c, window, x_stride, y_stride));
  }
  part.attributes = attributes_of(header);
  Imf::InputPart input(file, index);
  input.setFrameBuffer(buffer);
  input.readPixels(window.min.y, window.max.y);
  return part;
}

}  // namespace

Result<std::vector<ImagePart>> decoded_exr(const std::string& content, const std::string& name) {
  if (Imf::globalThreadCount() == 0 && threads() > 1) Imf::setGlobalThreadCount(threads());
  // What is no EXR file at all is the library's to tell.
  if (content.starts_with("\x76\x2f\x31\x01") && !header_ends_within(content))
    return input_error("{}: is cut off within its header", name);
  try {
    MemoryInput stream(content, name);
    Imf::MultiPartInputFile file(stream, threads());
    std::vector<ImagePart> parts;
    for (int i = 0; i < file.parts(); ++i) {
      GONIO_ASSIGN(auto part, decoded_part(file, i, name, content.size()));
      parts.push_back(std::move(part));
    }
    return parts;
  } catch (const std::bad_alloc&) {
    return input_error("{}: is too large for the memory there is", name);
  } catch (const std::exception& e) {
    return input_error("{}: cannot be read as EXR: {}", name, e.what());
  }
}

Result<std::vector<ImagePart>> read_exr(const std::string& path) {
  GONIO_ASSIGN(const std::string content, file_content(path));
  const std::string name = path == "-" ? "standard input" : path;
  if (content.empty()) return input_error("{}: is empty", name);
  return decoded_exr(content, name);
}

}  // namespace goniochrome::image
