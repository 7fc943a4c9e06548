// The programs of OpenGL. The shading program is written for one scene and contains only the effects and lobes that the
// scene uses. goniochrome-theory(7), RENDERING.
#pragma once

#include <string>
#include <vector>

#include "render/effects.h"

namespace goniochrome::render {

// Draws the G-buffer: unit normal, turned to the viewer, and part + 1 (negative where a surface is seen from inside);
// and, as a second picture, the number of the triangle.
std::string gbuffer_vertex_shader();
std::string gbuffer_fragment_shader();

// Covers the picture, and shades each point of the G-buffer.
std::string shading_vertex_shader();
// The operator is written into it where the effects have it. `tilted` are the exponents of tilted lobes.
std::string shading_fragment_shader(const Effects& effects, const color::ReflectionOperator& op,
                                    const std::vector<double>& tilted);

}  // namespace goniochrome::render
