// The finder of the surfaces that a picture shows, and the remarks about them.
#pragma once

#include "render/gbuffer.h"
#include "render/renderer.h"
#include "request.h"
#include "stage.h"

namespace goniochrome::tool {

// A picture of which nothing is asked ends after these seconds.
constexpr double kQuick_s = 5;

// The renderer, with OpenGL for engines that need it. Error: there is none.
Result<render::Renderer> make_renderer(const Options& options, const Request& request, const Stage& stage,
                                       cli::Session& session);

// Warns of a camera that sees the mesh from inside, or not at all, which is legal and hardly ever meant; and of single
// parts of which only back sides are seen.
void tell_visibility(const render::Gbuffer& gbuffer, const mesh::Mesh& mesh, cli::Session& session);

// The mean luminance of the visible mesh: a scene that only its own parts light is exposed by it.
double mean_luminance(const render::Frame& frame);

// The mean luminance that a picture is exposed to show.
constexpr double kMiddleGray = 0.18;

// The paints of the parts, for --explain.
std::string explanation(const Options& options, const mesh::Mesh& mesh, const DressedMesh& dress);

// Tells by --explain and the report which OpenGL draws, if any does.
void tell_opengl(const render::Renderer& renderer, cli::Session& session);

}  // namespace goniochrome::tool
