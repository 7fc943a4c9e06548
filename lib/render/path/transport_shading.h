// Pictures of other paints from a transport, in milliseconds. goniochrome-transport(7), "TRANSPORT".
#pragma once

#include <vector>

#include "color/reflection.h"
#include "image/image.h"
#include "render/path/bounce_scale.h"
#include "render/path/lobe_transport.h"

namespace goniochrome::render {

// A paint of a part, by column: one set of weights, or several by the angle of the viewer.
struct TransportPaint {
  std::vector<double> view_deg;                  // ascending; one entry where the weights hold for every view
  std::vector<std::vector<color::Rgb>> weights;  // for each
  // Where the image in the mirror lobe goes with the view otherwise than under the coat that light was traced through:
  // what it is there relative to the weights, by whole degrees from 0 to 90. Else empty.
  std::vector<float> mirror_by_view = {};
};
// Error: as column_weights().
Result<TransportPaint> transport_paint(const LobeColumns& columns, const paint::LobeFit& paint, double gloss_deg);

// The angle of the viewer from the normal at each point with lobes, else 0, by the buffers that the points were seen
// in, one for each sample of the pixels.
std::vector<float> view_angles_deg(const LobeTransport& transport, const std::vector<const Gbuffer*>& samples);

// Shades the columns of a transport that were read; it must outlive the shader.
class TransportShader {
 public:
  // `view_deg`: of each point, the angle of its viewer from the normal; may be empty where no paint changes with it.
  TransportShader(const LobeTransport& transport, std::vector<float> view_deg);

  // Writes the radiance of every point, times `gain`, to R G B of its pixel, and 1 to A. `paints` by part.
  // Bit-identical for any number of threads.
  void shade(const std::vector<TransportPaint>& paints, const color::ReflectionOperator* reflection,
             const BounceScale& scale, float gain, image::Image& rgba) const;

  std::size_t bytes() const;

 private:
  const LobeTransport& light_;
  std::vector<float> view_deg_;
  std::vector<std::size_t> columns_;  // that were read, the diffuse one first
};

}  // namespace goniochrome::render
