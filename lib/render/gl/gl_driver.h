// Where OpenGL contexts without a window come from: OSMesa, which is Mesa's software renderer as one library, or EGL,
// which has the software renderer and the GPUs of the machine. Both libraries are looked for when a context is first
// wanted, because Mesa ended OSMesa in version 25.1, and because programs that may draw, but do not, should start
// without the compiler of 100 MB that comes with them.
#pragma once

#include <memory>

#include "base/result.h"
#include "render/gl/driver.h"
#include "render/gl/gl_choice.h"

namespace goniochrome::render {

// A driver whose new OpenGL 3.3 core context is current. Error: the libraries are not there, or make no such context,
// with what to install.
Result<std::shared_ptr<const GlDriver>> make_gl_driver(OpenGlBy by);

}  // namespace goniochrome::render
