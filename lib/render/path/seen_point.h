// The points that a camera sees along one ray: a point, or a pane and the points behind it.
// goniochrome-coats(7), "PANES".
#pragma once

#include <cstdint>
#include <vector>

#include "render/panes.h"
#include "render/path/point_transport.h"

namespace goniochrome::render {

class SeenPoint {
 public:
  // `spot` is of transport.eye(), and `to_viewer` is unit. The transport must outlive the point.
  SeenPoint(const Transport& transport, const PathOptions& options, const rays::Spot& spot,
            const rays::Float3& to_viewer)
      : front_(transport, options, spot, to_viewer) {
    if (transport.meets_pane({spot.triangle, spot.u, spot.v, 0})) look_behind(transport, options, spot, to_viewer);
  }

  // True as PointTransport has it; each point behind panes counts by the light that these let through.
  bool certain() const {
    bool certain = front_.certain();
    for (const Behind& point : behind_) certain = certain && point.at.certain();
    return certain;
  }
  color::Rgb deterministic() const {
    color::Rgb sum = front_.deterministic();
    for (const Behind& point : behind_) sum += static_cast<double>(point.passed) * point.at.deterministic();
    return sum;
  }
  LightShares shares_of(const Sequence& sequence, std::uint32_t first, std::uint32_t count) const {
    LightShares sum = front_.certain() ? LightShares{} : front_.shares_of(sequence, first, count);
    for (const Behind& point : behind_)
      if (!point.at.certain()) sum += static_cast<double>(point.passed) * point.at.shares_of(sequence, first, count);
    return sum;
  }
  color::Rgb floor_light() const {
    color::Rgb sum = front_.floor_light();
    for (const Behind& point : behind_) sum += static_cast<double>(point.passed) * point.at.floor_light();
    return sum;
  }

 private:
  struct Behind {
    float passed;
    PointTransport at;
  };

  void look_behind(const Transport& transport, const PathOptions& options, rays::Spot spot,
                   const rays::Float3& to_viewer) {
    const rays::Float3 direction = -to_viewer;
    float share = 1;
    while (share > kLeastPassed) {
      const PassedPane passed = through_pane(transport.eye(), spot, direction);
      if (!passed.hit.any()) return;
      share *= passed.passed;
      const rays::Spot next = transport.eye().spot(passed.hit, spot.position, direction);
      behind_.push_back({share, PointTransport(transport, options, next, to_viewer)});
      if (!transport.meets_pane(passed.hit)) return;
      spot = next;
    }
  }

  PointTransport front_;
  std::vector<Behind> behind_;
};

}  // namespace goniochrome::render
