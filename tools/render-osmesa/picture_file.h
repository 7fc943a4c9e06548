// Pictures as EXR files, with the buffers and the attributes by which they can be shaded again.
#pragma once

#include "display/display.h"
#include "image/frames.h"
#include "image/image.h"
#include "paints.h"
#include "render/exact.h"
#include "render/renderer.h"
#include "request.h"
#include "sight.h"
#include "transport_view.h"

namespace goniochrome::tool {

// The tool, its version and its command line; and the view of a picture that `display` shows, by which it can be
// undone.
image::Attributes provenance(const cli::Session& session, const display::Display* display = nullptr);

// The parts of an EXR file: the picture with the buffers of --aov, and the parts of a transport, where there is one.
// `dress`: what the parts wear.
Result<std::vector<image::ImagePart>> exr_picture(const Options& options, const Request& request,
                                                  const render::Frame& frame, const render::Scene& scene,
                                                  const DressedMesh& dress, const render::Plan& plan,
                                                  const Exposure& exposure, const render::TransportParts* transport,
                                                  const cli::Session& session);

// The picture as a frame of --to exr: not compressed and without its plan, so that all frames have the same size.
Result<std::string> exr_frame(std::vector<image::ImagePart> picture);

// Frames of --to y4m, ppm and exr on standard output, one behind the other.
class FrameOutput {
 public:
  explicit FrameOutput(const std::string& to)
      : head_(to == "y4m"), format_(to == "ppm" ? image::FrameFormat::kPpm : image::FrameFormat::kY4m) {}

  std::string content(const image::ByteImage& shown) const { return image::frame_content(format_, shown); }
  // All frames have this size.
  Result<void> write(const std::string& frame, const PictureSize& size);

 private:
  bool head_;  // whether one comes before the next frame
  image::FrameFormat format_;
};

}  // namespace goniochrome::tool
