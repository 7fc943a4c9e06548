// What each lobe of a basis gathers of an environment where no surface is in the way, by the environment's prefiltered
// maps. goniochrome-theory(7), RENDERING and TRANSPORT.
#pragma once

#include <vector>

#include "base/result.h"
#include "render/effects.h"
#include "render/path/lobe_columns.h"

namespace goniochrome::render {

class OpenLight {
 public:
  // For columns whose exponents are among those of the environment. `tilts` of each part, as tilts_of() has them; none:
  // isotropic. The environment must outlive it. Error: a lobe that it lacks, the diffuse map, or the mirror part.
  static Result<OpenLight> create(const envmap::PrefilteredEnvironment& env, const LobeColumns& columns,
                                  std::vector<std::vector<brdf::Tilt>> tilts);

  // Writes the light of each column with weight 1 at a point seen from there; both vectors unit, on one side.
  void at(const Vec3& normal, const Vec3& to_viewer, int part, color::Rgb* light) const;

 private:
  OpenLight() = default;
  double weight(std::size_t column, int slot, double cos_o, int channel) const;

  const envmap::PrefilteredEnvironment* env_ = nullptr;
  LobeColumns columns_;
  std::vector<const envmap::PrefilteredLobe*> lobes_;  // of the columns' exponents
  std::vector<std::vector<brdf::Tilt>> tilts_;
  WeightTable table_;  // of a paint for each column, with weight 1 there alone
};

}  // namespace goniochrome::render
