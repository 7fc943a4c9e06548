// The finder of the surfaces that a picture shows, and the remarks about them.
#pragma once

#include "render/exact.h"
#include "render/gbuffer.h"
#include "render/renderer.h"
#include "request.h"
#include "stage.h"

namespace goniochrome::tool {

// A picture of which nothing is asked ends after these seconds.
constexpr double kQuick_s = 5;

// How much trouble engines take that draw by random samples.
render::Effort effort_of(const Options& options, const Request& request, cli::Session& session);

// The renderer, with OpenGL for engines that need it. Error: there is none.
Result<render::Renderer> make_renderer(const Options& options, const Request& request, const Stage& stage,
                                       cli::Session& session);

// The light that a picture is exposed by, and how.
struct Exposure {
  render::DiffuseWhite white;
  double stops = 0, automatic = 0;  // in force, and that of a PNG
  bool is_metered = true;           // whether there is light that the automatic exposure follows

  // By the luminance of a white diffuser that faces the camera.
  void meter(double white_luminance, const Request& request);
};

// Begins to draw the stage, of which this is seen: tells that and which OpenGL draws, by --explain and the report,
// completes the request of the plan, and meters the light. It warns of a camera that sees the mesh from inside, or not
// at all, which is legal and hardly ever meant; and of single parts of which only back sides are seen.
Exposure begin_sight(const render::Renderer& renderer, const render::Gbuffer& seen, const Stage& stage,
                     Request& request, cli::Session& session);

// The luminance of a white diffuser by that of the visible mesh, which is taken for middle gray: a scene that only its
// own parts light is exposed by it.
double white_by_gray(const render::Frame& frame);

// Reports pictures that were drawn: the times are those of one.
void report_pictures(const render::Plan& plan, const Exposure& exposure, std::size_t count, double gbuffer_ms,
                     double frame_ms, cli::Session& session);

// The paints of the parts, for --explain.
std::string explanation(const Options& options, const mesh::Mesh& mesh, const DressedMesh& dress);

}  // namespace goniochrome::tool
