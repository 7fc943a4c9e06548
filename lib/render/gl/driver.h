// An OpenGL context without a window.
#pragma once

namespace goniochrome::render {

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

}  // namespace goniochrome::render
