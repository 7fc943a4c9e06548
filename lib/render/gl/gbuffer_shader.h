// The program that draws the G-buffer of a page, and how all programs begin. goniochrome-rendering(7), "RENDERING".
#pragma once

#include <string>

namespace goniochrome::render {

// The first line of every program.
inline constexpr const char* kHead = "#version 330 core\n";

// Pixels as rays; both programs see the same, so a viewing direction needs no position. A program that includes kRays
// includes kPixel, or another definition of pixel(), before it.
inline constexpr const char* kPixel = "vec2 pixel() { return gl_FragCoord.xy; }\n";
inline constexpr const char* kRays =
    R"(uniform vec3 corner, right, down;  // the ray through (x, y), in pixels from the upper left
vec3 ray() { return normalize(corner + pixel().x * right + pixel().y * down); }
)";

// Draws the G-buffer of a page: unit normal, turned to the viewer, and part + 1 (negative where a surface is seen from
// inside), to which 8 for each fifteenth of the lamps' light that is hidden is added, and depth times `reach`. A second
// picture is the occlusion of each pixel, as kOcclusion reads it.
std::string gbuffer_vertex_shader();
std::string gbuffer_fragment_shader();

}  // namespace goniochrome::render
