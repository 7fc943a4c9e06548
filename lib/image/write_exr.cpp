#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfCompression.h>
#include <OpenEXR/ImfEnvmapAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>

#include "base/file.h"
#include "base/parallel.h"
#include "image/image.h"

namespace goniochrome::image {

namespace {

constexpr float kMostHalf = 65504.0F;
constexpr int kZipLevel = 2;  // within 3 % of the size of the highest level at a fraction of its time

class MemoryOutput : public Imf::OStream {
 public:
  MemoryOutput() : OStream("memory") {}

  void write(const char bytes[], int count) override {
    const std::size_t end = position_ + static_cast<std::size_t>(count);
    if (end > content_.size()) content_.resize(end);
    std::memcpy(content_.data() + position_, bytes, static_cast<std::size_t>(count));
    position_ = end;
  }
  std::uint64_t tellp() override { return position_; }
  void seekp(std::uint64_t position) override { position_ = position; }
  const std::string& content() const { return content_; }

 private:
  std::string content_;
  std::size_t position_ = 0;
};

std::vector<std::string> channel_names(const Image& image) {
  if (static_cast<int>(image.channel_names.size()) == image.channels) return image.channel_names;
  if (image.channels == 1) return {"Y"};
  std::vector<std::string> names = {"R", "G", "B", "A"};
  for (int c = 4; c < image.channels; ++c) names.push_back(fmt::format("channel{}", c));
  names.resize(static_cast<std::size_t>(image.channels));
  return names;
}

// The type that holds every value of the part. Error: the first value that is not finite, by pixel.
Result<PixelType> storage_type(const ImagePart& part, const std::vector<std::string>& names) {
  const Image& image = part.image;
  float most = 0;
  for (std::size_t i = 0; i < image.data.size(); ++i) {
    const float size = std::fabs(image.data[i]);
    if (!std::isfinite(size)) {
      const std::size_t pixel = i / image.channels;
      return input_error("part {}: pixel {},{} channel {} is {}: only finite values are written", part.name,
                         pixel % image.width, pixel / image.width, names[i % image.channels], image.data[i]);
    }
    most = std::max(most, size);
  }
  return most > kMostHalf ? PixelType::kFloat : part.type;
}

void set_attributes(Imf::Header& header, const Attributes& attributes) {
  for (const auto& [name, value] : attributes) {
    const auto* text = std::get_if<std::string>(&value);
    if (name == "envmap" && text)
      header.insert(name, Imf::EnvmapAttribute(*text == "cube" ? Imf::ENVMAP_CUBE : Imf::ENVMAP_LATLONG));
    else if (text)
      header.insert(name, Imf::StringAttribute(*text));
    else if (const auto* number = std::get_if<float>(&value))
      header.insert(name, Imf::FloatAttribute(*number));
    else if (const auto* whole = std::get_if<int>(&value))
      header.insert(name, Imf::IntAttribute(*whole));
    else if (const auto* xy = std::get_if<std::vector<float>>(&value); xy && xy->size() == 8)
      header.insert(name, Imf::ChromaticitiesAttribute(Imf::Chromaticities(
                              {(*xy)[0], (*xy)[1]}, {(*xy)[2], (*xy)[3]}, {(*xy)[4], (*xy)[5]}, {(*xy)[6], (*xy)[7]})));
  }
}

Imf::Header header_of(const ImagePart& part, PixelType type, const std::vector<std::string>& names,
                      const Imath::Box2i& display) {
  const Imath::Box2i data(Imath::V2i(0, 0), Imath::V2i(part.image.width - 1, part.image.height - 1));
  Imf::Header header(display, data);
  set_attributes(header, part.attributes);
  header.compression() = Imf::ZIP_COMPRESSION;
  header.zipCompressionLevel() = kZipLevel;
  header.setType(Imf::SCANLINEIMAGE);
  header.setName(part.name);
  for (const std::string& name : names)
    header.channels().insert(name, Imf::Channel(type == PixelType::kHalf ? Imf::HALF : Imf::FLOAT));
  return header;
}

// `values` as halves, rounded to nearest even.
std::vector<half> halves(const std::vector<float>& values) {
  std::vector<half> rounded(values.size());
  constexpr std::size_t kChunk = 1 << 16;
  parallel_for(values.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) rounded[i] = half(values[i]);
  });
  return rounded;
}

void write_part(Imf::MultiPartOutputFile& file, int index, const ImagePart& part, PixelType type,
                const std::vector<std::string>& names) {
  const Image& image = part.image;
  const bool as_half = type == PixelType::kHalf;
  const std::vector<half> rounded = as_half ? halves(image.data) : std::vector<half>();
  const std::size_t size = as_half ? sizeof(half) : sizeof(float);
  const char* base =
      as_half ? reinterpret_cast<const char*>(rounded.data()) : reinterpret_cast<const char*>(image.data.data());
  Imf::FrameBuffer buffer;
  for (int c = 0; c < image.channels; ++c)
    buffer.insert(names[c], Imf::Slice(as_half ? Imf::HALF : Imf::FLOAT, const_cast<char*>(base) + c * size,
                                       size * image.channels, size * image.channels * image.width));
  Imf::OutputPart output(file, index);
  output.setFrameBuffer(buffer);
  output.writePixels(image.height);
}

Result<std::string> encoded(const std::vector<ImagePart>& given) {
  std::vector<ImagePart> unnamed;  // only filled where names are missing
  const bool name_all = std::any_of(given.begin(), given.end(), [](const ImagePart& p) { return p.name.empty(); });
  if (name_all) {
    unnamed = given;
    for (std::size_t i = 0; i < unnamed.size(); ++i)
      if (unnamed[i].name.empty()) unnamed[i].name = fmt::format("part-{:03}", i);
  }
  const std::vector<ImagePart>& parts = name_all ? unnamed : given;

  // The format wants one display window for all parts.
  Imath::Box2i display(Imath::V2i(0, 0), Imath::V2i(0, 0));
  for (const ImagePart& part : parts) display.extendBy(Imath::V2i(part.image.width - 1, part.image.height - 1));
  std::vector<PixelType> types;
  std::vector<std::vector<std::string>> names;
  std::vector<Imf::Header> headers;
  for (const ImagePart& part : parts) {
    names.push_back(channel_names(part.image));
    GONIO_ASSIGN(const PixelType type, storage_type(part, names.back()));
    types.push_back(type);
    headers.push_back(header_of(part, type, names.back(), display));
  }
  if (Imf::globalThreadCount() == 0 && threads() > 1) Imf::setGlobalThreadCount(threads());
  MemoryOutput stream;
  {
    Imf::MultiPartOutputFile file(stream, headers.data(), static_cast<int>(headers.size()), false, threads());
    for (std::size_t i = 0; i < parts.size(); ++i) write_part(file, static_cast<int>(i), parts[i], types[i], names[i]);
  }
  return stream.content();
}

}  // namespace

Result<void> write_exr(const std::string& path, const std::vector<ImagePart>& parts) {
  const std::string shown = path.empty() || path == "-" ? "standard output" : path;
  try {
    auto content = encoded(parts);
    if (!content.ok()) return input_error("{}: {}", shown, content.error().message);
    return write_file(path, content.value());
  } catch (const std::exception& e) {
    return input_error("{}: cannot be written as EXR: {}", shown, e.what());
  }
}

}  // namespace goniochrome::image
