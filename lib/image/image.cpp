#include <dlfcn.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "base/file.h"
#include "image/hdr.h"
#include "image/image.h"
#include "image/internal/exr.h"
#include "image/internal/oiio_module.h"

namespace goniochrome::image {

namespace {

constexpr const char* kModuleName = "goniochrome-oiio.so";

// The module's path: in $GONIOCHROME_MODULE_PATH where that is set, else in ../lib/goniochrome beside the program.
std::filesystem::path module_path() {
  if (const char* folder = std::getenv("GONIOCHROME_MODULE_PATH")) return std::filesystem::path(folder) / kModuleName;
  std::error_code ignored;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", ignored);
  return program.parent_path().parent_path() / "lib" / "goniochrome" / kModuleName;
}

struct Module {
  GoniochromeOiioRead read = nullptr;
};

// The module, loaded once. Error: where it was looked for, and the remedy.
Result<Module> loaded_module() {
  static Module loaded;
  if (loaded.read) return loaded;
  const std::string path = module_path().string();
  void* handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!handle)
    return input_error(
        "{}: cannot be loaded ({}): it reads every format but EXR; install it there, set GONIOCHROME_MODULE_PATH to "
        "its folder, or convert the image to EXR",
        path, dlerror());
  loaded.read = reinterpret_cast<GoniochromeOiioRead>(dlsym(handle, kOiioReadName));
  if (!loaded.read) return input_error("{}: is not of this version of Goniochrome: install both from one build", path);
  return loaded;
}

struct Decoded {
  ImagePart part;
  std::string failure;
};

void take(void* context, const GoniochromeOiioImage* image) {
  ImagePart& part = static_cast<Decoded*>(context)->part;
  part.type = PixelType::kFloat;
  part.image.width = image->width;
  part.image.height = image->height;
  part.image.channels = image->channels;
  part.image.data.assign(image->pixels,
                         image->pixels + static_cast<std::size_t>(image->width) * image->height * image->channels);
  part.image.channel_names.assign(image->channel_names, image->channel_names + image->channels);
  const auto keep = [&](const char* name, const std::string& value) {
    if (!value.empty()) part.attributes[name] = value;
  };
  keep("oiio:ColorSpace", image->color_space);
  keep("colorInteropID", image->interop_id);
  keep("envmap", image->envmap);
  if (image->icc_profile) keep("ICCProfile", std::string(image->icc_profile, image->icc_size));
  part.attributes["goniochrome:integer"] = image->is_integer;
  if (image->chromaticities)
    part.attributes["chromaticities"] = std::vector<float>(image->chromaticities, image->chromaticities + 8);
}

void fail(void* context, const char* reason) {
  std::string text = reason && *reason ? reason : "unknown reason";
  while (!text.empty() && text.back() == '\n') text.pop_back();
  static_cast<Decoded*>(context)->failure = text;
}

Result<ImagePart> read_through_module(const std::string& path, const std::string& shown, Inks inks) {
  GONIO_ASSIGN(const Module module, loaded_module());
  Decoded decoded;
  module.read(path.c_str(), inks == Inks::kKept, &decoded, take, fail);
  if (!decoded.failure.empty()) return input_error("{}: cannot be read as an image: {}", shown, decoded.failure);
  return std::move(decoded.part);
}

// Reads standard input, kept as a file in memory, because the library reads files by name.
Result<ImagePart> read_content_through_module(const std::string& content, Inks inks) {
  const int fd = memfd_create("goniochrome", MFD_CLOEXEC);
  if (fd < 0) return input_error("standard input: cannot be kept in memory");
  std::size_t done = 0;
  while (done < content.size()) {
    const ssize_t count = write(fd, content.data() + done, content.size() - done);
    if (count <= 0) break;
    done += static_cast<std::size_t>(count);
  }
  auto part = done == content.size() ? read_through_module(fmt::format("/proc/self/fd/{}", fd), "standard input", inks)
                                     : Result<ImagePart>(input_error("standard input: cannot be kept in memory"));
  close(fd);
  return part;
}

}  // namespace

Result<ImagePart> read_image(const std::string& path, Inks inks) {
  GONIO_ASSIGN(InputFile input, InputFile::open(path));
  const bool piped = path.empty() || path == "-";
  std::string content;
  if (piped) {
    GONIO_ASSIGN(content, input.rest(std::string::npos));
  }
  GONIO_ASSIGN(const std::string_view first, input.peek());
  const std::string_view head = piped ? content : first;
  if (head.empty()) return input_error("{}: is empty: name an image", input.name());
  const bool exr = is_exr(head), radiance = is_radiance(head);
  if (!piped && (exr || radiance)) {
    GONIO_ASSIGN(content, input.rest(std::string::npos));
  }
  if (exr) {
    GONIO_ASSIGN(auto parts, decoded_exr(content, input.name()));
    return std::move(parts.front());
  }
  if (radiance) {
    GONIO_ASSIGN(auto part, decoded_hdr(content, input.name()));
    if (part) return std::move(*part);
  }
  return piped ? read_content_through_module(content, inks) : read_through_module(path, input.name(), inks);
}

}  // namespace goniochrome::image
