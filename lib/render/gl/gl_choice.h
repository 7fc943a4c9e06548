// Which OpenGL a renderer draws by.
#pragma once

namespace goniochrome::render {

enum class OpenGlBy {
  kSoftware,  // OSMesa where it is installed, else the software renderer of EGL
  kOsmesa,
  kEgl,  // the software renderer of EGL
  kGpu,  // the first GPU that EGL offers
};

}  // namespace goniochrome::render
