// Where OpenGL contexts without a window come from: OSMesa, which is Mesa's software renderer as one library, or EGL,
// which has the software renderer and the GPUs of the machine. Both libraries are looked for when a context is first
// wanted, because Mesa ended OSMesa in version 25.1, and because programs that may draw, but do not, should start
// without the compiler of 100 MB that comes with them.
#pragma once

#include <memory>

#include "base/result.h"

namespace goniochrome::render {

enum class OpenGlBy {
  kSoftware,  // OSMesa where it is installed, else the software renderer of EGL
  kOsmesa,
  kEgl,  // the software renderer of EGL
  kGpu,  // the first GPU that EGL offers
};

// One context, which is destroyed with its driver.
class GlDriver {
 public:
  virtual ~GlDriver() = default;
  GlDriver() = default;
  GlDriver(const GlDriver&) = delete;
  GlDriver& operator=(const GlDriver&) = delete;

  // Makes the context that of this thread.
  virtual void make_current() const = 0;
  // The function of that name, such as "glClear"; null where there is none.
  virtual void* address(const char* name) const = 0;
  // "OSMesa" or "EGL".
  virtual const char* name() const = 0;
  // True where a GPU draws instead of the processor.
  virtual bool on_gpu() const { return false; }
};
using GlDriverPointer = std::shared_ptr<const GlDriver>;

// A driver whose new OpenGL 3.3 core context is current. Error: the libraries are not there, or make no such context,
// with what to install.
Result<GlDriverPointer> gl_driver(OpenGlBy by);

// A driver of EGL alone: on its first GPU, or by its software renderer. Error: as gl_driver().
Result<GlDriverPointer> egl_driver(bool on_gpu);

}  // namespace goniochrome::render
