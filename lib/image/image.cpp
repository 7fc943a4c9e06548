#include <dlfcn.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <new>
#include <optional>

#include "base/child.h"
#include "base/file.h"
#include "base/paths.h"
#include "image/byte_image.h"
#include "image/exr.h"
#include "image/hdr.h"
#include "image/image.h"
#include "image/internal/codec_module.h"
#include "image/internal/content_format.h"
#include "image/internal/exr.h"
#include "image/internal/other_formats.h"
#include "image/internal/png_colors.h"
#include "image/internal/turn.h"

namespace goniochrome::image {

namespace {

constexpr const char* kModuleName = "goniochrome-codecs.so";
constexpr int kMostChannels = 1024;  // of one picture

// The module's path: in $GONIOCHROME_MODULE_PATH where that is set, else in ../lib/goniochrome beside the program.
std::filesystem::path module_path() {
  if (const char* folder = std::getenv("GONIOCHROME_MODULE_PATH")) return std::filesystem::path(folder) / kModuleName;
  const std::filesystem::path program = link_target("/proc/self/exe").value_or("");
  return program.parent_path().parent_path() / "lib" / "goniochrome" / kModuleName;
}

struct Module {
  GoniochromeDecode decode = nullptr;
};

// The module. Error: where it was looked for, and the remedy.
Result<Module> loaded_module() {
  const std::string path = module_path().string();
  void* handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!handle) {
    // The loader tells by a sentence alone that it had no memory.
    const std::string reason = dlerror();
    for (const char* words : {"failed to map", "annot allocate memory", "cannot create shared object"})
      if (reason.find(words) != std::string::npos) throw std::bad_alloc();
    return input_error(
        "{}: cannot be loaded ({}): it reads PNG, JPEG and TIFF; install it there, set GONIOCHROME_MODULE_PATH to its "
        "folder, or convert the image to EXR",
        path, reason);
  }
  const Module module{reinterpret_cast<GoniochromeDecode>(dlsym(handle, kDecodeName))};
  if (!module.decode)
    return input_error("{}: is not of this version of Goniochrome: install both from one build", path);
  return module;
}

// A picture on its way from the child process: numbers and texts, one after the other, and then the pixels.
struct Numbers {
  std::int32_t width, height, channels, is_integer, is_inks;
};

void put_text(ChildOutput& output, std::string_view text) {
  const std::uint64_t size = text.size();
  output.write(&size, sizeof size);
  output.write(text.data(), text.size());
}

struct Decoded {
  ChildOutput& output;
  std::optional<std::string> failure = "the library that reads it said nothing";
};

void take(void* context, const GoniochromeDecoded* image) {
  auto& decoded = *static_cast<Decoded*>(context);
  ChildOutput& output = decoded.output;
  const Numbers numbers{image->width, image->height, image->channels, image->is_integer, image->is_inks};
  output.write(&numbers, sizeof numbers);
  for (const char* text : {image->color_space, image->interop_id, image->envmap}) put_text(output, text);
  put_text(output, image->icc_profile ? std::string_view(image->icc_profile, image->icc_size) : std::string_view());
  for (int c = 0; c < image->channels; ++c) put_text(output, image->channel_names[c]);
  output.write(image->pixels, sizeof(float) * static_cast<std::size_t>(image->width) * image->height * image->channels);
  decoded.failure.reset();
}

void fail(void* context, const char* reason) {
  std::string text = reason && *reason ? reason : "unknown reason";
  while (!text.empty() && text.back() == '\n') text.pop_back();
  static_cast<Decoded*>(context)->failure = text;
}

// Takes the picture that the child wrote apart again. Nothing in it is sure but its size.
class Parcel {
 public:
  explicit Parcel(std::string_view bytes) : rest_(bytes) {}

  bool take_bytes(void* to, std::size_t size) {
    if (rest_.size() < size) return false;
    std::memcpy(to, rest_.data(), size);
    rest_.remove_prefix(size);
    return true;
  }
  bool take_text(std::string& text) {
    std::uint64_t size = 0;
    if (!take_bytes(&size, sizeof size) || size > rest_.size()) return false;
    text = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return true;
  }
  std::size_t left() const { return rest_.size(); }

 private:
  std::string_view rest_;
};

std::optional<ImagePart> unpacked(std::string_view bytes) {
  Parcel parcel(bytes);
  Numbers numbers;
  if (!parcel.take_bytes(&numbers, sizeof numbers)) return std::nullopt;
  if (numbers.width < 1 || numbers.height < 1 || numbers.channels < 1 || numbers.channels > kMostChannels)
    return std::nullopt;
  ImagePart part;
  part.type = PixelType::kFloat;
  part.image.width = numbers.width, part.image.height = numbers.height, part.image.channels = numbers.channels;
  for (const char* key : {"oiio:ColorSpace", "colorInteropID", "envmap", "ICCProfile"}) {
    std::string text;
    if (!parcel.take_text(text)) return std::nullopt;
    if (!text.empty()) part.attributes[key] = text;
  }
  part.image.channel_names.resize(static_cast<std::size_t>(numbers.channels));
  for (std::string& name : part.image.channel_names)
    if (!parcel.take_text(name)) return std::nullopt;
  part.attributes["goniochrome:integer"] = static_cast<int>(numbers.is_integer);
  if (numbers.is_inks != 0) part.attributes["goniochrome:inks"] = 1;
  const std::size_t samples = parcel.left() / sizeof(float);
  const std::size_t row = static_cast<std::size_t>(numbers.width) * static_cast<std::size_t>(numbers.channels);
  if (parcel.left() % sizeof(float) != 0 || samples % row != 0 ||
      samples / row != static_cast<std::size_t>(numbers.height))
    return std::nullopt;
  part.image.data.resize(samples);
  parcel.take_bytes(part.image.data.data(), samples * sizeof(float));
  return part;
}

// Addresses for one picture: those of the libraries, and 8 times the floats that a file of its size can hold.
ChildLimits limits_for(std::size_t file_bytes) {
  constexpr std::size_t kOwn = std::size_t{1} << 28, kFloatsAByte = 1100;
  const std::size_t floats = std::min(kMostSamples, kFloatsAByte * file_bytes);
  return {kOwn + 8 * sizeof(float) * floats, 60 + static_cast<int>(file_bytes >> 20)};
}

// A child process loads the module, which takes 3 ms, and decodes.
Result<ImagePart> decoded_by_module(const std::string& content, const std::string& format, const std::string& name,
                                    Inks inks) {
  const std::size_t size = content.size();
  GONIO_ASSIGN(const ChildBytes bytes, made_by_child(name, limits_for(size), [&](ChildOutput& output) -> Result<void> {
                 GONIO_ASSIGN(const Module module, loaded_module());
                 Decoded decoded{output};
                 module.decode(content.data(), size, format.c_str(), inks == Inks::kKept, &decoded, take, fail);
                 if (!decoded.failure) return {};
                 return input_error("{}: cannot be read as an image: {}", name, *decoded.failure);
               }));
  auto part = unpacked(bytes.view());
  if (!part)
    return input_error("{}: the library that reads it lost its way: the file is damaged: export it again", name);
  return std::move(*part);
}

}  // namespace

std::string image_file(const std::string& path) {
  const std::size_t bracket = path.rfind('[');
  const bool names_layer = path.ends_with(']') && bracket != std::string::npos && bracket > 0 && !is_there(path);
  return names_layer ? path.substr(0, bracket) : path;
}

Result<ImagePart> read_image(const std::string& path, Inks inks) {
  const std::string file = image_file(path);
  const std::string layer = file == path ? "" : path.substr(file.size() + 1, path.size() - file.size() - 2);
  GONIO_ASSIGN(InputFile input, InputFile::open(file));
  GONIO_ASSIGN(std::string content, input.rest(std::string::npos));
  if (content.empty()) return input_error("{}: is empty: name an image", input.name());
  GONIO_ASSIGN(const std::string format, content_format(content, input.name()));
  if (format == "openexr") return decoded_exr_picture(content, input.name(), layer);
  if (!layer.empty())
    return input_error("{}: has no layers: leave out [{}], which names one of an EXR file", file, layer);
  if (format == "hdr") return decoded_hdr(content, input.name());
  if (format == "pnm") return decoded_pnm(content, input.name());
  const bool by_module = format == "png" || format == "jpeg" || format == "tiff";
  GONIO_ASSIGN(ImagePart part, by_module ? decoded_by_module(content, format, input.name(), inks)
                                         : decoded_by_oiiotool(content, format, input.name()));
  Attributes colors = format == "png" ? png_colors(content) : Attributes();
  if (colors.contains("oiio:ColorSpace")) part.attributes.erase("ICCProfile");
  if (colors.empty() && text_attribute(part, "ICCProfile").empty()) colors = stated_colors(content, format);
  for (auto& [name, value] : colors) part.attributes[name] = std::move(value);
  if (std::string view = format == "png" ? png_text(content, kViewAttribute) : ""; !view.empty())
    part.attributes[kViewAttribute] = std::move(view);
  Image& image = part.image;
  const Turn turn = exif_turn(exif_orientation(content, format));
  if (turn.any()) image.data = upright(image.data, image.width, image.height, image.channels, turn);
  return part;
}

}  // namespace goniochrome::image
