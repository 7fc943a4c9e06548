// --aov transport: the light of a view by lobes; and pictures of other paints from it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/clock.h"
#include "base/result.h"
#include "envmap/environment.h"
#include "image/aov_file.h"
#include "paints.h"
#include "render/light_transport.h"
#include "render/renderer.h"
#include "request.h"
#include "tool.h"

namespace goniochrome::tool {

// A view whose light was traced. Its G-buffer is that of the rays, which the picture's buffers must show.
struct TracedView {
  std::shared_ptr<const render::Gbuffer> gbuffer;
  render::TransportParts file;
  bool reached = false;  // whether its noise is within the tolerance
};

// Checks that the light of the scene is a sum of lobes. Error: what it wears that is none.
Result<void> can_trace_view(const render::Scene& scene);

// Traces what is seen through `rays` in all that the scene has, as the mean over so many samples of a pixel, and tells
// how. `with_maps`: open light by the environment's maps, else by rays alone. The scene is one that can_trace_view()
// accepts. Error: what paths do not trace; maps that the environment lacks.
Result<TracedView> traced_view(const render::Scene& scene, const envmap::Environment* environment, bool with_maps,
                               const render::Gbuffer& seen, int samples, double white_luminance, int bounces,
                               cli::Session& session);

// The transport of --gbuffer, at first without light, and what its file says of the light.
struct KeptTransport {
  render::LobeTransport light;
  image::AovFile file;  // without its pictures
};
// Nothing where there is no light, or where the command line has other light than the file, which is told. Error
// (usage): bounced light was traced with another operator.
Result<std::optional<KeptTransport>> kept_transport(std::optional<render::LobeTransport> points, image::AovFile file,
                                                    const Options& options, const Request& request,
                                                    cli::Session& session);

// Reads the light that this dress of the mesh weighs; without one, that of all lobes. Error: as render::read_light().
Result<void> read_light(const DressedMesh* dress, const mesh::Mesh& mesh, KeptTransport& transport);

// The results of shading a view in some paints.
struct ShadedPaint {
  double frame_ms = 0, scale_ms = 0;  // to shade; and to scale bounced light
  bool scaled = false;                // whether bounced light was traced in other paints
  double bounced_de00_p95 = 0;        // what scaling it errs by
  bool coat_changed = false;          // whether a coat took the place of none, or none that of a coat
};

// Shows the light of one view in any number of paints. What is given must outlive it; of the scene, the mesh's parts,
// the operator, the environment and the background are read.
class ViewShader {
 public:
  // `samples` of the pixels, one G-buffer each, lie below each other in the light.
  ViewShader(const render::LobeTransport& light, std::vector<const render::Gbuffer*> samples,
             const render::Scene& scene);

  // Makes `picture` that of these paints, R G B A, with the scene's background. A picture that shade() made before is
  // drawn over. Error: a paint that the light cannot show.
  Result<ShadedPaint> shade(const DressedMesh& dress, image::Image& picture);

  // `transport` of the report.
  Json figures(const ShadedPaint& shaded, double tolerance) const;

 private:
  const render::LobeTransport& light_;
  std::vector<const render::Gbuffer*> samples_;
  const render::Scene& scene_;
  Stopwatch laying_;
  render::TransportShader shader_;
  double load_ms_;
  render::BounceScaler scaler_;
};

}  // namespace goniochrome::tool
