// A traced view as a page holds it: its transport in few bytes, and what is seen beside the mesh. It says no more than
// shading takes, so that it also unpacks where there are no files. goniochrome-transport(7), "Packed views".
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "image/image.h"
#include "render/path/lobe_transport.h"
#include "render/path/shown_paints.h"

namespace goniochrome::render {

// A page keeps the light of a view in memory. A view of more points is refused.
constexpr std::size_t kMostPagePoints = std::size_t{1} << 19;

// Light is rounded to as few bits as change the gray paint of its column (nominal_weight()), as it is seen with all of
// its light, by no more than this: CIEDE2000, 95th percentile over some of the points.
constexpr double kPackedError_de00 = 0.02;

// Smooth planes of bytes, which a general compressor makes much smaller. `view_deg` is what TransportShader takes, one
// angle for every point; they are rounded to 1/50 degree. `beside` has what is seen beside the points, R G B A for
// every pixel; without pixels there is nothing. Shares of classes are rounded to 1/2047, and the light of probes to 8
// bits. Error: too many points.
Result<std::string> packed_view(const LobeTransport& transport, const std::vector<float>& view_deg,
                                const image::Image& beside);

struct UnpackedView {
  LobeTransport light;  // without noise
  std::vector<float> view_deg;
  image::Image beside;  // R G B A; 0 at the points
};
// Error: the bytes are not those of packed_view().
Result<UnpackedView> unpacked_view(std::string_view bytes);

// The change of pictures by packing: the largest mean and the largest 95th percentile over all points, CIEDE2000 before
// the white of the scene, in any of these paints. `reflection` as bounce_scale() takes it.
struct PackingError {
  double mean_de00 = 0, p95_de00 = 0;
};
PackingError packing_error(const LobeTransport& transport, const std::vector<float>& view_deg, const UnpackedView& view,
                           const std::vector<ShownPaints>& paints, const color::ReflectionOperator* reflection);

// Every n-th pixel of the picture, both ways, without probes, and which points these are.
struct Thinned {
  LobeTransport light;
  std::vector<std::uint32_t> points;
};
Thinned thinned(const LobeTransport& transport, int n);

}  // namespace goniochrome::render
