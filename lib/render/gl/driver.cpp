#include "render/gl/driver.h"

#include <sys/mman.h>

#include <cstdlib>

#include "base/parallel.h"
#include "render/gl/late_library.h"

namespace goniochrome::render {

namespace {

// OSMesa wants a window to draw in; everything here goes to framebuffer objects instead.
constexpr int kWindow = 4;
unsigned char window_pixels[kWindow * kWindow * 4];

// Mesa's interface of OSMesa (GL/osmesa.h), declared here because Mesa ended it in version 25.1.
using OSMesaContext = struct OsmesaContext*;
constexpr int kFormat = 0x22, kDepthBits = 0x30, kProfile = 0x33, kCoreProfile = 0x34, kMajorVersion = 0x36,
              kMinorVersion = 0x37, kRgba = 0x1908;
constexpr unsigned kUnsignedByte = 0x1401;  // GL_UNSIGNED_BYTE

constexpr const char* kOsmesaLibrary = "libOSMesa.so.8";
struct OSMesa {
  LateLibrary library{kOsmesaLibrary};
  OSMesaContext (*create)(const int* attributes, OSMesaContext shared) = nullptr;
  unsigned char (*make_current)(OSMesaContext context, void* pixels, unsigned type, int width, int height) = nullptr;
  void (*destroy)(OSMesaContext context) = nullptr;
  void (*(*address)(const char* name))() = nullptr;
};

// The library, loaded once. Error: it is not there, or is another one.
Result<const OSMesa*> osmesa() {
  static const OSMesa loaded = [] {
    OSMesa of;
    of.library.find(of.create, "OSMesaCreateContextAttribs");
    of.library.find(of.make_current, "OSMesaMakeCurrent");
    of.library.find(of.destroy, "OSMesaDestroyContext");
    of.library.find(of.address, "OSMesaGetProcAddress");
    return of;
  }();
  if (loaded.library.complete()) return &loaded;
  return input_error("{} of Mesa 22 or later cannot be loaded{}", kOsmesaLibrary, loaded.library.reason());
}

class OsmesaDriver : public GlDriver {
 public:
  OsmesaDriver(const OSMesa& library, OSMesaContext context) : library_(library), context_(context) {}
  ~OsmesaDriver() override { library_.destroy(context_); }

  void make_current() const override {
    library_.make_current(context_, window_pixels, kUnsignedByte, kWindow, kWindow);
  }
  void* address(const char* name) const override { return reinterpret_cast<void*>(library_.address(name)); }
  const char* name() const override { return "OSMesa"; }

 private:
  const OSMesa& library_;
  OSMesaContext context_;
};

Result<GlDriverPointer> osmesa_driver() {
  GONIO_ASSIGN(const OSMesa* library, osmesa());
  const int wanted[] = {kFormat, kRgba, kDepthBits, 0, kProfile, kCoreProfile, kMajorVersion, 3, kMinorVersion, 3, 0};
  const OSMesaContext context = library->create(wanted, nullptr);
  if (context == nullptr)
    return input_error("OSMesa makes no OpenGL 3.3 core context: install libosmesa6 of Mesa 22 or later");
  auto driver = std::make_shared<const OsmesaDriver>(*library, context);
  driver->make_current();
  return GlDriverPointer(std::move(driver));
}

// True if there is as much address space as Mesa takes beside its libraries: short of it, it crashes.
bool has_room() {
  constexpr std::size_t kRoom = std::size_t{448} << 20;
  void* room = mmap(nullptr, kRoom, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  return room != MAP_FAILED && munmap(room, kRoom) == 0;
}

}  // namespace

Result<GlDriverPointer> gl_driver(OpenGlBy by) {
  // Read once, when the first context of the process is made.
  setenv("LP_NUM_THREADS", std::to_string(threads()).c_str(), 0);
  const auto with_room = [](auto make) -> Result<GlDriverPointer> {
    if (has_room()) return make();
    return input_error("OpenGL takes some 450 MB of address space, which are not there: give more memory");
  };
  if (by == OpenGlBy::kGpu || by == OpenGlBy::kEgl) return with_room([by] { return egl_driver(by == OpenGlBy::kGpu); });
  const Result<const OSMesa*> there = osmesa();
  if (there.ok()) return with_room(osmesa_driver);
  const auto nothing = [&](const std::string& also) {
    return input_error(
        "{}{}: install libosmesa6, or libegl1 with libegl-mesa0 and libgl1-mesa-dri, or give more memory",
        there.error().message, also);
  };
  if (by == OpenGlBy::kOsmesa) return nothing("");
  auto other = with_room([] { return egl_driver(false); });
  if (!other.ok()) return nothing(", and " + other.error().message);
  return other;
}

}  // namespace goniochrome::render
