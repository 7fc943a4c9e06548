// Lookups in cube maps that do not depend on how finely a GPU interpolates.
#pragma once

#include <string>

namespace goniochrome::render {

// The program with lookups in cube maps that are interpolated in single precision. GPUs place a lookup between two
// texels in steps of 1/256, which is seen where neighboring texels differ much. The textures of the program must have
// the filter GL_NEAREST. At the corners of the cube, where three texels meet, the fourth is their mean, as
// envmap::bilinear() and seamless cubes of OpenGL have it.
std::string with_exact_lookups(const std::string& program);

}  // namespace goniochrome::render
