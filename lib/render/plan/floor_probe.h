// What a floor that shows the environment changes of the picture beside the mesh, and how long drawing it takes,
// measured at some of its points. goniochrome-theory(7), PLAN, Effects of rays.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "render/gbuffer.h"
#include "render/plan/ray_probe.h"

namespace goniochrome::render {

// A point of the floor, and what the picture shows there without it.
struct FloorPoint {
  RayPoint at;
  color::Rgb instead;
  bool is_near = false;  // the mesh may change what is seen there, so that it needs samples
};

// Up to so many of the pixels of these buffers that show the floor beside the mesh, evenly spread.
struct FloorPixels {
  std::vector<FloorPoint> points;
  double count = 0;       // of all such pixels
  double near_count = 0;  // of those that need samples, as far as the points tell
};
FloorPixels floor_pixels(const Transport& over_floor, const Scene& scene, const envmap::Environment* environment,
                         const std::vector<std::shared_ptr<const Gbuffer>>& gbuffers, std::size_t most);

class FloorProbe {
 public:
  // Bit-identical for any number of threads, but for the time that it measures. `pixels` must outlive it.
  FloorProbe(const ProbeSetting& setting, const FloorPixels& pixels);

  Worth worth() const;
  // As RayProbe::cost(), of `floor_pixels` pixels of a picture, near ones or not.
  RayCost cost(const RayEffects& effects, double tolerance_de00, double floor_pixels, int samples) const;

 private:
  struct Light {
    LightShares sure;
    std::vector<LightShares> fans;
  };
  LightShares mean(std::size_t i, std::size_t first, std::size_t step) const;

  const FloorPixels& pixels_;
  std::vector<Light> light_;
  double white_ = 1, batch_ms_ = 0;
};

}  // namespace goniochrome::render
