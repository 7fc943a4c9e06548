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

// This is follow() at a vertex on such a floor, with the light of its first step apart.
Transport::FloorLight Transport::off_floor(const Hit& hit, const Float3& origin, const Float3& direction, int bounces,
                                           const Sequence& sequence, std::uint32_t index, std::uint32_t set) const {
  if (shaded_ != nullptr) {
    const LightShares shown = met_ground(hit, origin, direction, sequence.point(index, set)[0]);
    return {shown.direct, bounces > 0 ? shown.into_diffuse : color::Rgb{}};
  }
  const Vertex vertex(*this, rays_->spot(hit, origin, direction), -direction);
  if (vertex.painted.black()) return {vertex.open, {}};
  Channels fixed(reflection_);
  const Next next = step(vertex, sequence.point(index, set), sequence.point(index, set + 1), fixed);
  FloorLight light{vertex.open + fixed.sum(), {}};
  if (!next.goes_on() || !next.hit.any() || bounces == 0) return light;
  light.bounced = fixed.shown(bounced(next.hit, next.start, next.direction, bounces, sequence, index, set + 2));
  return light;
}

}  // namespace goniochrome::render
