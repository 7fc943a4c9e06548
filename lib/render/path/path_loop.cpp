#include "render/path/path_loop.h"

namespace goniochrome::render {

using rays::Float3;
using rays::Hit;

color::Rgb Transport::bounced(const Hit& hit, const Float3& origin, const Float3& direction, int bounces,
                              const Sequence& sequence, std::uint32_t index, std::uint32_t set) const {
  Channels light(reflection_);
  follow(hit, origin, direction, bounces, sequence, index, set, light);
  return light.sum();
}

Transport::FloorLight Transport::off_floor(const Hit& hit, const Float3& origin, const Float3& direction, int bounces,
                                           const Sequence& sequence, std::uint32_t index, std::uint32_t set) const {
  if (shaded_ != nullptr) {
    const LightShares shown = met_ground(hit, origin, direction, sequence.point(index, set)[0]);
    return {shown.direct, bounces > 0 ? shown.into_diffuse : color::Rgb{}};
  }
  const Vertex vertex(*this, rays_->spot(hit, origin, direction), -direction);
  Channels light(reflection_);
  send(vertex, bounces, sequence, index, set, light);
  return {vertex.open + light.sum(), light.deeper()};
}

}  // namespace goniochrome::render
