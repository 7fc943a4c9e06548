#include "render/gl/gl_driver.h"

#include <GL/osmesa.h>
#include <sys/mman.h>

#include <cstdlib>

#include "base/parallel.h"
#include "render/gl/egl_driver.h"
#include "render/gl/late_library.h"

namespace goniochrome::render {

namespace {

// OSMesa wants a window to draw in; everything here goes to framebuffer objects instead.
constexpr int kWindow = 4;
unsigned char window_pixels[kWindow * kWindow * 4];

constexpr const char* kOsmesaLibrary = "libOSMesa.so.8";
struct OSMesa {
  LateLibrary library{kOsmesaLibrary};
  decltype(&OSMesaCreateContextAttribs) create = nullptr;
  decltype(&OSMesaMakeCurrent) make_current = nullptr;
  decltype(&OSMesaDestroyContext) destroy = nullptr;
  decltype(&OSMesaGetProcAddress) address = nullptr;
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
    library_.make_current(context_, window_pixels, GL_UNSIGNED_BYTE, kWindow, kWindow);
  }
  void* address(const char* name) const override { return reinterpret_cast<void*>(library_.address(name)); }
  const char* name() const override { return "OSMesa"; }

 private:
  const OSMesa& library_;
  OSMesaContext context_;
};

Result<std::shared_ptr<const GlDriver>> osmesa_driver() {
  GONIO_ASSIGN(const OSMesa* library, osmesa());
  const int wanted[] = {OSMESA_FORMAT,
                        OSMESA_RGBA,
                        OSMESA_DEPTH_BITS,
                        0,
                        OSMESA_PROFILE,
                        OSMESA_CORE_PROFILE,
                        OSMESA_CONTEXT_MAJOR_VERSION,
                        3,
                        OSMESA_CONTEXT_MINOR_VERSION,
                        3,
                        0};
  const OSMesaContext context = library->create(wanted, nullptr);
  if (context == nullptr)
    return input_error("OSMesa makes no OpenGL 3.3 core context: install libosmesa6 of Mesa 22 or later");
  auto driver = std::make_shared<const OsmesaDriver>(*library, context);
  driver->make_current();
  return std::shared_ptr<const GlDriver>(std::move(driver));
}

// Whether as much address space is to be had as Mesa takes beside its libraries: short of it, it crashes.
bool has_room() {
  constexpr std::size_t kRoom = std::size_t{448} << 20;
  void* room = mmap(nullptr, kRoom, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  return room != MAP_FAILED && munmap(room, kRoom) == 0;
}

}  // namespace

Result<std::shared_ptr<const GlDriver>> make_gl_driver(OpenGlBy by) {
  // Read once, when the first context of the process is made.
  setenv("LP_NUM_THREADS", std::to_string(threads()).c_str(), 0);
  const auto with_room = [](auto make) -> Result<std::shared_ptr<const GlDriver>> {
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
