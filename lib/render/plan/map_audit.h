// Prefiltered maps beside sums over the environment, at some of the points that a picture shows, where no surface is in
// the way of light. goniochrome-plan(7), "Error of the maps".
#pragma once

#include <memory>

#include "envmap/block_tree.h"
#include "render/cpu/cpu_engine.h"
#include "render/path/open_residual.h"
#include "render/plan.h"

namespace goniochrome::render {

struct MapAudit {
  const Scene& scene;  // as the engine has it
  const Effects& effects;
  const CpuEngine& maps;            // with that scene and these effects
  OpenResidual* sums;               // that correct the maps; null: none
  const envmap::BlockTree* texels;  // of the environment that the maps were made from; null: it is not at hand
  bool sums_may_stop = false;       // where nobody asked for them
  double tolerance_de00 = 1, white_luminance = 1;

  // Points are those of one sample of each pixel, of so many.
  FoundMaps found(const std::shared_ptr<const Gbuffer>& seen, int samples) const;
};

}  // namespace goniochrome::render
