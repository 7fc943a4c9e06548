// Pictures as EXR files, with the buffers and the attributes by which they can be shaded again.
#pragma once

#include "display/display.h"
#include "image/image.h"
#include "paints.h"
#include "render/exact.h"
#include "render/renderer.h"
#include "request.h"
#include "transport_view.h"

namespace goniochrome::tool {

// The tool, its version and its command line; and the view of a picture that `display` shows, by which it can be
// undone.
image::Attributes provenance(const cli::Session& session, const display::Display* display = nullptr);

// The parts of an EXR file: the picture with the buffers of --aov, and the parts of a transport, where there is one.
// `stops`: the exposure of the picture; `automatic`: the one that a PNG would get. `dress`: what the parts wear.
Result<std::vector<image::ImagePart>> exr_picture(const Options& options, const Request& request,
                                                  const render::Frame& frame, const render::Scene& scene,
                                                  const DressedMesh& dress, const render::Plan& plan,
                                                  const render::DiffuseWhite& white, double stops, double automatic,
                                                  const render::TransportParts* transport, const cli::Session& session);

// The picture as a frame of --to exr: not compressed and without its plan, so that all frames have the same size.
Result<std::string> exr_frame(std::vector<image::ImagePart> picture);

}  // namespace goniochrome::tool
