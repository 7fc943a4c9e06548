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
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>
#include <OpenEXR/ImfVecAttribute.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <exception>
#include <new>
#include <span>
#include <stdexcept>

#include "base/file.h"
#include "base/large_pages.h"
#include "base/parallel.h"
#include "image/exr.h"
#include "image/image.h"
#include "image/internal/exr.h"
#include "image/internal/exr_header.h"
#include "image/internal/exr_layers.h"
#include "image/internal/exr_rows.h"

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
    else if (const auto* point = dynamic_cast<const Imf::V2fAttribute*>(&value); point && name == "adoptedNeutral")
      attributes[name] = std::vector<float>{point->value().x, point->value().y};
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

// The channels that are wanted, as far as the part has them.
std::vector<std::string> wanted_channels(const Imf::ChannelList& list, const std::vector<std::string>& wanted) {
  std::vector<std::string> names;
  for (const std::string& name : wanted)
    if (list.findChannel(name)) names.push_back(name);
  return names;
}

// Makes the library's own pool of threads, once and only if it helps.
void use_threads() {
  if (Imf::globalThreadCount() == 0 && threads() > 1) Imf::setGlobalThreadCount(threads());
}

// Throws if the file ends before the last scan lines of a part: those of one that is passed over must be there as well.
void expect_last_line(Imf::MultiPartInputFile& file, int index, const Imath::Box2i& window) {
  if (file.header(index).hasTileDescription()) return;
  const char* bytes = nullptr;
  int size = 0;
  Imf::InputPart(file, index).rawPixelData(window.max.y, bytes, size);
}

ExrWindow window_of(const Imath::Box2i& box) {
  return {box.min.x, box.min.y, box.max.x - box.min.x + 1, box.max.y - box.min.y + 1};
}

// True if a part is shown as it is stored. All parts share one display window, so that parts of sizes of their own, as
// those of an environment, begin at its corner; in the pictures of other programs these are crops. Parts of this
// program may also stand elsewhere in a picture.
bool fills_its_window(const Imf::MultiPartInputFile& file, int index, const Attributes& attributes, bool as_picture) {
  const Imath::Box2i &data = file.header(index).dataWindow(), &display = file.header(index).displayWindow();
  if (data == display) return true;
  const bool is_own =
      std::ranges::any_of(attributes, [](const auto& entry) { return entry.first.starts_with("goniochrome:"); });
  if (file.parts() == 1 || (data.min != display.min && (as_picture || !is_own))) return false;
  return !as_picture || attributes.contains("envmap") || is_own;
}

// Brings the pixels of a data window into the display window. A forged window must not ask for all memory.
Result<void> place_in_window(const Imf::Header& header, const std::string& where, Image& image) {
  constexpr std::size_t kFreePixels = std::size_t{1} << 26, kMostTimes = 64;
  const ExrWindow display = window_of(header.displayWindow()), data = window_of(header.dataWindow());
  const std::size_t pixels = image.data.size() / static_cast<std::size_t>(image.channels);
  const auto width = static_cast<std::size_t>(display.width), height = static_cast<std::size_t>(display.height);
  if (width * height > std::max(kFreePixels, kMostTimes * pixels) ||
      width * height > kMostSamples / static_cast<std::size_t>(image.channels))
    return input_error("{}: its display window of {} x {} is too large for its {} x {} pixels: crop it", where, width,
                       height, data.width, data.height);
  if (!header.displayWindow().intersects(header.dataWindow()))
    return input_error("{}: none of its pixels lies in its display window: export it again", where);
  image = shown_in(display, data, std::move(image));
  return {};
}

// Fills `image.data` with the channels that `image` names.
Result<void> read_pixels(Imf::MultiPartInputFile& file, int index, const std::string& where, Image& image) {
  const Imf::Header& header = file.header(index);
  if (has_rows(header)) {
    read_rows(file, index, image);
    return {};
  }
  use_threads();
  const Imath::Box2i& window = header.dataWindow();
  Imf::FrameBuffer buffer;
  const std::size_t x_stride = sizeof(float) * image.channels, y_stride = x_stride * image.width;
  for (int c = 0; c < image.channels; ++c) {
    const Imf::Channel& channel = header.channels()[image.channel_names[c].c_str()];
    if (channel.xSampling != 1 || channel.ySampling != 1)
      return input_error("{}: channel {} is subsampled: convert it to full resolution", where, image.channel_names[c]);
    buffer.insert(image.channel_names[c],
                  Imf::Slice::Make(Imf::FLOAT, image.data.data() + c, window, x_stride, y_stride));
  }
  Imf::InputPart input(file, index);
  input.setFrameBuffer(buffer);
  input.readPixels(window.min.y, window.max.y);
  return {};
}

// The pixels take the memory of `room`, as far as it goes.
Result<ImagePart> decoded_part(Imf::MultiPartInputFile& file, int index, const std::string& file_name,
                               std::size_t file_bytes, const ExrWanted& wanted, bool as_picture = false,
                               std::vector<float> room = {}) {
  const Imf::Header& header = file.header(index);
  ImagePart part;
  if (header.hasName()) part.name = header.name();
  const std::string where = part.name.empty() ? file_name : fmt::format("{}: part {}", file_name, part.name);
  if (header.hasType() && Imf::isDeepData(header.type()))
    return input_error("{}: holds deep data: flatten it first", where);
  if (!file.partComplete(index)) return input_error("{}: is cut off: some scan lines are missing", where);
  part.attributes = attributes_of(header);
  const Imath::Box2i& window = header.dataWindow();
  if (wanted.part && !wanted.part(part.name, part.attributes)) {
    expect_last_line(file, index, window);
    return part;
  }

  Image& image = part.image;
  part.left = window.min.x - header.displayWindow().min.x, part.top = window.min.y - header.displayWindow().min.y;
  image.width = window.max.x - window.min.x + 1;
  image.height = window.max.y - window.min.y + 1;
  const bool some = index == wanted.channels_of && !wanted.channels.empty();
  image.channel_names =
      some ? wanted_channels(header.channels(), wanted.channels) : ordered_channels(header.channels());
  image.channels = static_cast<int>(image.channel_names.size());
  const std::size_t samples = static_cast<std::size_t>(image.width) * image.height * image.channels;
  if (image.channels == 0 && some) return part;
  if (samples == 0) return input_error("{}: holds no pixels", where);
  if (samples > kMostSamples || samples / most_samples_a_byte(header.compression()) > file_bytes)
    return input_error("{}: {} x {} pixels are too many for a file of {} bytes", where, image.width, image.height,
                       file_bytes);
  image.data = std::move(room);
  resize_on_large_pages(image.data, samples);

  part.type = PixelType::kHalf;
  for (const std::string& name : image.channel_names)
    if (as_picture && header.channels()[name.c_str()].type == Imf::UINT)
      return input_error(
          "{}: its channel {} holds whole numbers, of which 1 is no known light: convert it to half or float", where,
          name);
  for (const std::string& name : image.channel_names)
    if (header.channels()[name.c_str()].type != Imf::HALF) part.type = PixelType::kFloat;
  GONIO_TRY(read_pixels(file, index, where, image));
  if (!fills_its_window(file, index, part.attributes, as_picture)) {
    part.left = part.top = 0;
    GONIO_TRY(place_in_window(header, where, image));
  }
  return part;
}

// Turns what the library throws into an error.
template <class Read>
auto guarded(const std::string& name, Read&& read) -> decltype(read()) {
  try {
    return read();
  } catch (const std::bad_alloc&) {
    return input_error("{}: is too large for the memory there is", name);
  } catch (const std::exception& e) {
    return input_error("{}: cannot be read as EXR: {}", name, e.what());
  }
}

struct OpenedExr {
  OpenedExr(const std::string& content, const std::string& name) : stream(content, name), file(stream, threads()) {}
  MemoryInput stream;
  Imf::MultiPartInputFile file;
};

// Opens a file in memory and hands it to `read`.
template <class Read>
auto opened(const std::string& content, const std::string& name, Read&& read)
    -> decltype(read(std::make_shared<OpenedExr>(content, name))) {
  // The library itself tells that a file is no EXR file at all.
  if (is_exr(content) && !is_sound_exr_header(content))
    return input_error("{}: its header is damaged or cut off", name);
  return guarded(name, [&] { return read(std::make_shared<OpenedExr>(content, name)); });
}

// Error: a part beside the chosen one is not there as a whole.
Result<void> check_others(Imf::MultiPartInputFile& file, int chosen, const std::string& name) {
  const ExrWanted none{[](const std::string&, const Attributes&) { return false; }};
  for (int i = 0; i < file.parts(); ++i)
    if (i != chosen) GONIO_TRY(decoded_part(file, i, name, 0, none));
  return {};
}

Result<std::string> content_of(InputFile& input) {
  GONIO_ASSIGN(std::string content, input.rest(std::string::npos));
  if (content.empty()) return input_error("{}: is empty: name an EXR file", input.name());
  return content;
}

}  // namespace

Result<std::vector<ImagePart>> decoded_exr(const std::string& content, const std::string& name,
                                           const ExrWanted& wanted) {
  return opened(content, name, [&](const auto& exr) -> Result<std::vector<ImagePart>> {
    std::vector<ImagePart> parts;
    for (int i = 0; i < exr->file.parts(); ++i) {
      GONIO_ASSIGN(parts.emplace_back(), decoded_part(exr->file, i, name, content.size(), wanted));
    }
    return parts;
  });
}

Result<ImagePart> decoded_exr_picture(const std::string& content, const std::string& name, const std::string& layer) {
  return opened(content, name, [&](const auto& exr) -> Result<ImagePart> {
    Imf::MultiPartInputFile& file = exr->file;
    std::vector<ExrPartNames> names;
    for (int i = 0; i < file.parts(); ++i) {
      const Imf::Header& header = file.header(i);
      names.push_back({header.hasName() ? header.name() : "", ordered_channels(header.channels())});
    }
    GONIO_ASSIGN(const ExrLayer picture, color_layer(names, layer, name));
    const int chosen = static_cast<int>(picture.part);
    GONIO_TRY(check_others(file, chosen, name));
    GONIO_ASSIGN(ImagePart part,
                 decoded_part(file, chosen, name, content.size(), {{}, picture.channels, chosen}, true));
    part.image.channel_names = picture.as;
    return part;
  });
}

Result<std::vector<ImagePart>> read_exr(const std::string& path) {
  GONIO_ASSIGN(InputFile input, InputFile::open(path));
  GONIO_ASSIGN(const std::string content, content_of(input));
  return decoded_exr(content, input.name());
}

Result<OpenExr> open_exr(const std::string& path, const std::vector<std::string>& channels) {
  GONIO_ASSIGN(InputFile input, InputFile::open(path));
  GONIO_ASSIGN(std::string all, content_of(input));
  const auto content = std::make_shared<const std::string>(std::move(all));
  return opened(*content, input.name(), [&](const auto& exr) -> Result<OpenExr> {
    GONIO_TRY(check_others(exr->file, 0, input.name()));
    GONIO_ASSIGN(ImagePart first, decoded_part(exr->file, 0, input.name(), content->size(), {{}, channels}));
    const auto decode = [exr, content, file = input.name()](const std::string& name, ImagePart& part) {
      return guarded(file, [&]() -> Result<bool> {
        for (int i = 1; i < exr->file.parts(); ++i) {
          if (exr->file.header(i).name() != name) continue;
          GONIO_ASSIGN(part, decoded_part(exr->file, i, file, content->size(), {}, false, std::move(part.image.data)));
          return true;
        }
        return false;
      });
    };
    return OpenExr{std::move(first), decode};
  });
}

namespace {

constexpr float kMostHalf = 65504.0F;
// Halves lose digits below 2^-14. Where the largest light is below this, colors a 128th as bright would lose theirs.
constexpr float kDarkestHalf = 0x1p-7F;
constexpr int kZipLevel = 2;  // within 3 % of the size of the highest level at a fraction of its time

class MemoryOutput : public Imf::OStream {
 public:
  explicit MemoryOutput(std::size_t expected) : OStream("memory") { content_.reserve(expected); }

  void write(const char bytes[], int count) override {
    const std::size_t size = static_cast<std::size_t>(count);
    if (position_ == content_.size()) {
      content_.append(bytes, size);
    } else {
      if (position_ + size > content_.size()) content_.resize(position_ + size);
      std::memcpy(content_.data() + position_, bytes, size);
    }
    position_ += size;
  }
  std::uint64_t tellp() override { return position_; }
  void seekp(std::uint64_t position) override { position_ = position; }
  std::string take_content() { return std::move(content_); }

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
Result<PixelType> storage_type(const ImagePart& part) {
  if (auto finite = check_finite(part.image); !finite.ok())
    return input_error("part {}: {}", part.name, finite.error().message);
  const Image& image = part.image;
  const std::vector<std::string> names = channel_names(image);
  const auto channels = static_cast<std::size_t>(image.channels);
  float most = 0, most_light = 0;
  for (std::size_t i = 0; i < image.data.size(); ++i) {
    const float size = std::fabs(image.data[i]);
    most = std::max(most, size);
    if (names[i % channels] != "A") most_light = std::max(most_light, size);
  }
  const bool holds = most <= kMostHalf && (most_light == 0 || most_light >= kDarkestHalf);
  return holds ? part.type : PixelType::kFloat;
}

// True if compression is worth its time. Deflate finds next to nothing in floats of high precision: of maps that were
// rounded to 19 bits it left 90 %, for ten times the time of writing them as they are. Where the lowest byte of a tenth
// of the values is 0, as in empty areas and in values that were halves, it does find something.
bool is_compressible(const ImagePart& part, PixelType type) {
  if (type == PixelType::kHalf) return true;
  std::size_t full = 0;
  for (const float value : part.image.data) full += (std::bit_cast<std::uint32_t>(value) & 0xff) != 0;
  return 10 * full < 9 * part.image.data.size();
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

Imath::Box2i window_of(const ImagePart& part) {
  const Imath::V2i corner(part.left, part.top);
  return {corner, corner + Imath::V2i(part.image.width - 1, part.image.height - 1)};
}

Imf::Header header_of(const ImagePart& part, PixelType type, const std::vector<std::string>& names,
                      const Imath::Box2i& display, ExrStorage storage) {
  Imf::Header header(display, window_of(part));
  set_attributes(header, part.attributes);
  const bool packed = storage == ExrStorage::kZip && is_compressible(part, type);
  header.compression() = packed ? Imf::ZIP_COMPRESSION : Imf::NO_COMPRESSION;
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
    buffer.insert(names[c], Imf::Slice::Make(as_half ? Imf::HALF : Imf::FLOAT, base + c * size, window_of(part),
                                             size * image.channels, size * image.channels * image.width));
  Imf::OutputPart output(file, index);
  output.setFrameBuffer(buffer);
  output.writePixels(image.height);
}

// The bytes of the parts that are not compressed, with the place and the length of every row.
std::size_t plain_bytes(const std::vector<ImagePart>& parts, const std::vector<Imf::Header>& headers) {
  constexpr std::size_t kRow = 8 + 12, kHeader = 4096;
  std::size_t bytes = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (headers[i].compression() != Imf::NO_COMPRESSION) continue;
    const bool as_half = headers[i].channels().begin().channel().type == Imf::HALF;
    bytes += kHeader + kRow * static_cast<std::size_t>(parts[i].image.height) +
             (as_half ? sizeof(half) : sizeof(float)) * parts[i].image.data.size();
  }
  return bytes;
}

Result<std::string> encoded(const std::vector<ImagePart>& given, ExrStorage storage) {
  std::vector<ImagePart> unnamed;  // only filled where names are missing
  const bool name_all = std::any_of(given.begin(), given.end(), [](const ImagePart& p) { return p.name.empty(); });
  if (name_all) {
    unnamed = given;
    for (std::size_t i = 0; i < unnamed.size(); ++i)
      if (unnamed[i].name.empty()) unnamed[i].name = fmt::format("part-{:03}", i);
  }
  const std::vector<ImagePart>& parts = name_all ? unnamed : given;

  // The format wants one display window for all parts. A picture is shown as large as it is, whatever follows it.
  Imath::Box2i display(Imath::V2i(0, 0), Imath::V2i(0, 0));
  const bool is_picture = !parts.empty() && parts.front().name == "picture";
  for (const ImagePart& part : std::span(parts).first(is_picture ? 1 : parts.size()))
    display.extendBy(window_of(part).max);
  std::vector<PixelType> types;
  std::vector<std::vector<std::string>> names;
  std::vector<Imf::Header> headers;
  for (const ImagePart& part : parts) {
    names.push_back(channel_names(part.image));
    GONIO_ASSIGN(const PixelType type, storage_type(part));
    types.push_back(type);
    headers.push_back(header_of(part, type, names.back(), display, storage));
  }
  const auto is_packed = [](const Imf::Header& h) { return h.compression() != Imf::NO_COMPRESSION; };
  // The library gives every row of a part that is not compressed to a thread of its own: to hand it over takes longer
  // than to copy it.
  const bool packed = std::ranges::any_of(headers, is_packed);
  if (packed) use_threads();
  MemoryOutput stream(plain_bytes(parts, headers));
  {
    Imf::MultiPartOutputFile file(stream, headers.data(), static_cast<int>(headers.size()), false,
                                  packed ? threads() : 0);
    for (std::size_t i = 0; i < parts.size(); ++i) write_part(file, static_cast<int>(i), parts[i], types[i], names[i]);
  }
  return stream.take_content();
}

}  // namespace

Result<void> check_finite(const Image& image) {
  const auto bad = std::ranges::find_if_not(image.data, [](float value) { return std::isfinite(value); });
  if (bad == image.data.end()) return {};
  const auto at = static_cast<std::size_t>(bad - image.data.begin());
  const auto channels = static_cast<std::size_t>(image.channels), width = static_cast<std::size_t>(image.width);
  return input_error("pixel {},{} channel {} is {}: only finite values are written", at / channels % width,
                     at / channels / width, channel_names(image)[at % channels], *bad);
}

Result<std::string> exr_content(const std::string& name, const std::vector<ImagePart>& parts, ExrStorage storage) {
  try {
    auto content = encoded(parts, storage);
    if (!content.ok()) return input_error("{}: {}", name, content.error().message);
    return content;
  } catch (const std::bad_alloc&) {
    return input_error("{}: cannot be written as EXR: there is too little memory for it", name);
  } catch (const std::exception& e) {
    return input_error("{}: cannot be written as EXR: {}", name, e.what());
  }
}

Result<void> write_exr(const std::string& path, const std::vector<ImagePart>& parts) {
  GONIO_ASSIGN(const std::string content, exr_content(path.empty() || path == "-" ? "standard output" : path, parts));
  return write_file(path, content);
}

}  // namespace goniochrome::image
