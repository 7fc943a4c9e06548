#include "render/gl/driver.h"

#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <array>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "base/text.h"
#include "render/gl/late_library.h"

namespace goniochrome::render {

namespace {

constexpr const char* kEglLibrary = "libEGL.so.1";
struct Egl {
  LateLibrary library{kEglLibrary};
  decltype(&eglGetProcAddress) address = nullptr;
  decltype(&eglGetError) error = nullptr;
  decltype(&eglQueryString) text = nullptr;
  decltype(&eglInitialize) initialize = nullptr;
  decltype(&eglBindAPI) bind = nullptr;
  decltype(&eglChooseConfig) choose = nullptr;
  decltype(&eglCreateContext) create = nullptr;
  decltype(&eglDestroyContext) destroy = nullptr;
  decltype(&eglMakeCurrent) make_current = nullptr;
  PFNEGLGETPLATFORMDISPLAYEXTPROC display = nullptr;
  // Functions of extensions, so that they may be null.
  PFNEGLQUERYDEVICESEXTPROC devices = nullptr;
  PFNEGLQUERYDEVICESTRINGEXTPROC device_text = nullptr;
};

// True if a list of extensions, separated by spaces, has this one.
bool lists(const char* extensions, std::string_view name) {
  if (extensions == nullptr) return false;
  for (const std::string_view one : split(extensions, ' '))
    if (one == name) return true;
  return false;
}

// The library, loaded once. Error: it is not there, or knows no displays but windows.
Result<const Egl*> egl() {
  static const Egl loaded = [] {
    // Mesa warns on standard error of each device that it does not open.
    setenv("EGL_LOG_LEVEL", "fatal", 0);
    Egl of;
    of.library.find(of.address, "eglGetProcAddress");
    of.library.find(of.error, "eglGetError");
    of.library.find(of.text, "eglQueryString");
    of.library.find(of.initialize, "eglInitialize");
    of.library.find(of.bind, "eglBindAPI");
    of.library.find(of.choose, "eglChooseConfig");
    of.library.find(of.create, "eglCreateContext");
    of.library.find(of.destroy, "eglDestroyContext");
    of.library.find(of.make_current, "eglMakeCurrent");
    if (!of.library.complete()) return of;
    const char* extensions = of.text(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    if (lists(extensions, "EGL_EXT_platform_base"))
      of.display = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(of.address("eglGetPlatformDisplayEXT"));
    if (!lists(extensions, "EGL_EXT_platform_device")) return of;
    of.devices = reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(of.address("eglQueryDevicesEXT"));
    of.device_text = reinterpret_cast<PFNEGLQUERYDEVICESTRINGEXTPROC>(of.address("eglQueryDeviceStringEXT"));
    return of;
  }();
  if (!loaded.library.complete()) return input_error("{} cannot be loaded{}", kEglLibrary, loaded.library.reason());
  if (loaded.display == nullptr) return input_error("{} knows no displays without windows", kEglLibrary);
  return &loaded;
}

// The displays by which contexts on a GPU or by software may be had, the likeliest first. Displays belong to the
// process, and are never terminated.
std::vector<EGLDisplay> displays(const Egl& egl, bool on_gpu) {
  std::vector<EGLDisplay> found;
  const auto add = [&](EGLenum platform, void* native) {
    const EGLDisplay display = egl.display(platform, native, nullptr);
    if (display != EGL_NO_DISPLAY) found.push_back(display);
  };
  std::array<EGLDeviceEXT, 64> devices{};
  EGLint count = 0;
  if (egl.devices != nullptr && egl.device_text != nullptr &&
      egl.devices(static_cast<EGLint>(devices.size()), devices.data(), &count) == EGL_TRUE) {
    for (EGLint i = 0; i < count; ++i) {
      const EGLDeviceEXT device = devices[static_cast<std::size_t>(i)];
      const bool software = lists(egl.device_text(device, EGL_EXTENSIONS), "EGL_MESA_device_software");
      if (software != on_gpu) add(EGL_PLATFORM_DEVICE_EXT, device);
    }
  }
  if (lists(egl.text(EGL_NO_DISPLAY, EGL_EXTENSIONS), "EGL_MESA_platform_surfaceless"))
    add(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY);
  return found;
}

class EglDriver : public GlDriver {
 public:
  EglDriver(const Egl& egl, EGLDisplay display, EGLContext context, bool on_gpu)
      : egl_(egl), display_(display), context_(context), on_gpu_(on_gpu) {}
  ~EglDriver() override {
    egl_.make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    egl_.destroy(display_, context_);
  }

  void make_current() const override { egl_.make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_); }
  void* address(const char* name) const override { return reinterpret_cast<void*>(egl_.address(name)); }
  const char* name() const override { return "EGL"; }
  bool on_gpu() const override { return on_gpu_; }

 private:
  const Egl& egl_;
  EGLDisplay display_;
  EGLContext context_;
  bool on_gpu_;
};

// True if the current context draws on the processor.
bool draws_by_software(const Egl& egl) {
  using GetString = const unsigned char* (*)(unsigned);
  constexpr unsigned kRenderer = 0x1F01;  // GL_RENDERER
  const auto get_string = reinterpret_cast<GetString>(egl.address("glGetString"));
  const unsigned char* text = get_string != nullptr ? get_string(kRenderer) : nullptr;
  if (text == nullptr) return true;
  const std::string_view name = reinterpret_cast<const char*>(text);
  for (const char* known : {"llvmpipe", "softpipe", "swrast", "Software Rasterizer"})
    if (name.find(known) != std::string_view::npos) return true;
  return false;
}

// A context on this display. Error: what it lacks.
Result<GlDriverPointer> driver_on(const Egl& egl, EGLDisplay display, bool on_gpu) {
  const auto failed = [&](const char* what) { return input_error("{} (EGL error 0x{:04x})", what, egl.error()); };
  if (egl.initialize(display, nullptr, nullptr) != EGL_TRUE) return failed("a device cannot be opened");
  if (!lists(egl.text(display, EGL_EXTENSIONS), "EGL_KHR_surfaceless_context"))
    return input_error("a device draws into surfaces only");
  if (egl.bind(EGL_OPENGL_API) != EGL_TRUE) return failed("a device has no OpenGL");
  constexpr EGLint kKind[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
  EGLConfig config = EGL_NO_CONFIG_KHR;
  EGLint count = 0;
  if (egl.choose(display, kKind, &config, 1, &count) != EGL_TRUE || count == 0) config = EGL_NO_CONFIG_KHR;
  constexpr EGLint kWanted[] = {EGL_CONTEXT_MAJOR_VERSION_KHR,
                                3,
                                EGL_CONTEXT_MINOR_VERSION_KHR,
                                3,
                                EGL_CONTEXT_OPENGL_PROFILE_MASK_KHR,
                                EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT_KHR,
                                EGL_NONE};
  const EGLContext context = egl.create(display, config, EGL_NO_CONTEXT, kWanted);
  if (context == EGL_NO_CONTEXT) return failed("a device makes no OpenGL 3.3 core context");
  auto driver = std::make_shared<const EglDriver>(egl, display, context, on_gpu);
  if (egl.make_current(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) != EGL_TRUE)
    return failed("a context cannot be used");
  if (draws_by_software(egl) == on_gpu) return input_error("a device draws on {}", on_gpu ? "the processor" : "a GPU");
  return GlDriverPointer(std::move(driver));
}

}  // namespace

Result<GlDriverPointer> egl_driver(bool on_gpu) {
  const auto none = [on_gpu](const std::string& why) {
    if (!on_gpu) return input_error("EGL has no software renderer: {}", why);
    return input_error(
        "there is no GPU that OpenGL can draw on: {}: install libegl1 and the driver of the GPU with its EGL, or take "
        "another engine",
        why);
  };
  const Result<const Egl*> library = egl();
  if (!library.ok()) return on_gpu ? none(library.error().message) : library.error();
  std::string reasons;
  for (const EGLDisplay display : displays(**library, on_gpu)) {
    auto driver = driver_on(**library, display, on_gpu);
    if (driver.ok()) return driver;
    const std::string& why = driver.error().message;
    if (reasons.find(why) == std::string::npos) reasons += (reasons.empty() ? "" : ", ") + why;
  }
  return none(reasons.empty() ? "EGL finds no device" : reasons);
}

}  // namespace goniochrome::render
