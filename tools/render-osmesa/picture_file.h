// Pictures as EXR files, with the buffers and the attributes by which they can be shaded again.
#pragma once

#include "image/image.h"
#include "render/exact.h"
#include "render/renderer.h"
#include "request.h"
#include "transport_view.h"

namespace goniochrome::tool {

// The tool, its version and its command line.
image::Attributes provenance(const cli::Session& session);

// Writes the picture with the buffers of --aov and with the parts of a transport, where there is one. `stops`: the
// exposure of the picture; `automatic`: the one that a PNG would get. Error: as image::write_exr().
Result<void> write_exr_picture(const Options& options, const Request& request, const Shot& shot,
                               const render::Frame& frame, const render::Scene& scene, const render::Plan& plan,
                               const render::DiffuseWhite& white, double stops, double automatic,
                               const render::TransportParts* transport, const cli::Session& session);

}  // namespace goniochrome::tool
