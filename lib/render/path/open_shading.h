// What the diffuse part and the lobes of visible points show of an environment with nothing in the way of the light, by
// exact sums at few points and by prefiltered maps at all. goniochrome-theory(7), PATHS, Gathered light.
#pragma once

#include <memory>
#include <vector>

#include "base/result.h"
#include "render/cpu/cpu_engine.h"
#include "render/gbuffer.h"
#include "render/scene.h"

namespace goniochrome::render {

class OpenShading {
 public:
  // The scene must outlive it. A floor is the part after the last; one that shows the environment is black here. Where
  // the maps of the scene's environment lack a lobe of its paints, or where it has no maps, quick() is black.
  explicit OpenShading(const Scene& scene);

  // Scene-linear radiance without the mirror lobe and without directional lights. `tolerance_de00`: what 95 of 100
  // points may be off by. Bit-identical for any number of threads.
  std::vector<color::Rgb> exact(const std::vector<VisiblePoint>& points, double tolerance_de00) const;
  // The same by maps.
  std::vector<color::Rgb> quick(const std::vector<VisiblePoint>& points) const;
  // Adds to the first three channels of the picture `gain` times that of every pixel of the G-buffer.
  void add_quick(const Gbuffer& gbuffer, float gain, image::Image& rgba) const;

 private:
  Scene scene_;
  Effects effects_;
  std::unique_ptr<CpuEngine> maps_;  // none: black
};

}  // namespace goniochrome::render
