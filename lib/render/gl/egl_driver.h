// OpenGL contexts of EGL that have neither a window nor a surface.
#pragma once

#include <memory>

#include "base/result.h"
#include "render/gl/driver.h"

namespace goniochrome::render {

// A driver on the first GPU that makes an OpenGL 3.3 core context, or on the software renderer. Error: EGL is not
// installed, or offers none, with the reason; for a GPU also with what is needed.
Result<std::shared_ptr<const GlDriver>> egl_driver(bool on_gpu);

}  // namespace goniochrome::render
