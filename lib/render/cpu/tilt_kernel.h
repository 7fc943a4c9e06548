// Tilted lobes on the processor: at each point the directions of all look-ups lie side by side, and each is looked up
// in the map of its own lobe. The kernel is compiled for several instruction sets, as cpu_kernel.h is.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/cpu/cpu_kernel.h"
#include "render/internal/maps.h"
#include "render/internal/tilt_table.h"

namespace goniochrome::render {

// The look-ups of a part and segment are padded to a multiple of this.
constexpr std::size_t kTiltLanes = 16;

struct TiltShading {
  int segments = 0;                      // 0: nothing is tilted
  const std::int32_t* groups = nullptr;  // of each part
  const std::uint32_t* rows = nullptr;   // of a group and segment: where its look-ups begin; and one more for the end
  const float* axes = nullptr;           // 6 of each look-up in groups of kTiltLanes: a, s, c, and their steps
  const std::int32_t* places = nullptr;  // 2 of each look-up in such groups: size of the map, first texel
  const float* weights = nullptr;        // of each look-up: R G B 0, and its step
  const float* texels = nullptr;         // of all maps, R G B 0 each, faces with their border
  const float* product = nullptr;        // product_columns()
};

// Adds what the tilted lobes show to the colors of points. Their directions to the viewer must be unit.
void add_tilted(const TiltShading& shading, const PointArrays& points, int count, float* rgba);

// The maps and look-ups of a scene, which a TiltShading points to.
class TiltStore {
 public:
  // Interleaves the maps of these exponents. All of them must be there.
  void load(const envmap::PrefilteredEnvironment& env, const std::vector<double>& exponents);
  void load_paints(const Scene& scene, const Effects& effects);
  // It holds until the store is loaded again.
  TiltShading shading(const float* product) const;

 private:
  std::vector<double> exponents_;
  std::vector<std::int32_t> sizes_, firsts_;  // of the maps
  std::vector<float> texels_, axes_, weights_;
  std::vector<std::uint32_t> rows_;
  std::vector<std::int32_t> places_, groups_;
  bool any_ = false;
};

}  // namespace goniochrome::render
