// The programs of OpenGL. The shading program is written for one scene and contains only the effects and lobes that the
// scene uses. goniochrome-rendering(7), "RENDERING".
#pragma once

#include <string>

#include "render/effects.h"
#include "render/scene.h"

namespace goniochrome::render {

// Covers the picture, and shades each point of the G-buffer.
std::string shading_vertex_shader();
// The operator is written into it where the effects have it. Textures are added by the processor. On a page an
// environment in the background may lie on the ground: ground_eye is the camera's eye relative to the point above the
// ground from which the environment was seen, and ground_drop how far below that the ground lies; 0 for no ground.
// Light is dimmed by what is in its way, which the texture "occlusion" holds. goniochrome-paths(7), "Ground".
std::string shading_fragment_shader(const Effects& effects, const color::ReflectionOperator& op, bool on_page = false);

// One of these programs for OpenGL ES 3, which is what WebGL 2 draws with: it differs in its head alone. That of the
// G-buffer must be without triangles, whose numbers OpenGL ES 3 does not tell.
std::string for_opengl_es(const std::string& program);

}  // namespace goniochrome::render
