// The engine integral shades G-buffers without prefiltered maps: at every visible point it sums the environment itself,
// by blocks of texels that are as coarse as the lobes there allow. goniochrome-plan(7), "Sums over blocks".
#pragma once

#include <vector>

#include "render/cpu/cpu_engine.h"
#include "render/engine.h"

namespace goniochrome::render {

// The spread of blocks (see Surroundings) whose sums are within this color difference at 95 of 100 points; CIEDE2000.
double spread_for(double tolerance_de00);

class IntegralEngine : public Engine {
 public:
  static const EngineInfo kInfo;

  const EngineInfo& info() const override { return kInfo; }
  // Error: an environment without the image that it was made from.
  Result<void> can_shade(const Scene& scene) const override;
  // The blocks are as coarse as Effects::tolerance_de00 lets them be. Error: a background without a mirror part.
  Result<void> load(const Scene& scene, const Effects& effects) override;
  void load_paints(const Scene& scene) override;
  // Bit-identical for any number of threads.
  Result<void> shade(Sight& sight, int sample, float gain, bool add, image::Image& rgba) override;
  bool shades_layer() const override { return true; }

 private:
  CpuEngine behind_;  // the mesh: it draws the background alone
  Scene scene_;
  Effects effects_;
};

}  // namespace goniochrome::render
