// What a floor that shows the environment changes of the picture beside the mesh, and how long drawing it takes,
// measured at some of its points. goniochrome-theory(7), PLAN, Effects of rays.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "render/gbuffer.h"
#include "render/plan.h"
#include "render/plan/ray_probe.h"

namespace goniochrome::render {

// A point of the floor, and what the picture shows there without it.
struct FloorPoint {
  ProbePixel pixel;
  RayPoint at;
  color::Rgb instead;
};

// Up to so many of the pixels of these buffers that show the floor beside the mesh, evenly spread.
struct FloorPixels {
  std::vector<FloorPoint> points;
  double count = 0;  // of all such pixels
};
FloorPixels floor_pixels(const Transport& over_floor, const Scene& scene, const envmap::Environment* environment,
                         const std::vector<std::shared_ptr<const Gbuffer>>& gbuffers, std::size_t most);

class FloorProbe {
 public:
  // Of a transport whose ground is shaded.
  FloorProbe(const Transport& over_floor, double white_luminance, const FloorPixels& pixels);

  const Worth& worth() const { return worth_; }
  // Of drawing so many pixels of a picture, each of so many samples.
  double cost_ms(double floor_pixels, int samples) const { return point_ms_ * floor_pixels * samples; }

 private:
  Worth worth_;
  double point_ms_ = 0;
};

}  // namespace goniochrome::render
