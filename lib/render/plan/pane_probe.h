// What the points of a plan show through panes. goniochrome-theory(7), PANES.
#pragma once

#include <vector>

#include "rays/ray_scene.h"
#include "render/gbuffer.h"
#include "render/plan.h"
#include "render/plan/ray_probe.h"
#include "render/scene.h"

namespace goniochrome::render {

struct PaneProbe {
  struct Share {
    std::size_t point = 0, behind = 0;  // numbers of a point and of one behind it
    double passed = 0;                  // the part of its light that reaches the viewer
  };
  struct Beyond {
    std::size_t point = 0;
    color::Rgb light;  // of the background, as far as the panes pass it
  };
  std::vector<VisiblePoint> behind;
  std::vector<RayPoint> ray_points;  // the same
  std::vector<Share> shares;
  std::vector<Beyond> beyond;

  // Adds what is behind panes to the colors of the points.
  void add(const std::vector<color::Rgb>& of_behind, std::vector<color::Rgb>& colors) const;
};

// `pixels` are those of the points, whose G-buffers have triangles. Nothing without panes.
PaneProbe pane_probe(const rays::RayScene* whole, const Scene& scene, const std::vector<ProbePixel>& pixels);

}  // namespace goniochrome::render
