// Minification of textures: a pixel that covers many texels shows their mean, which is shaded at some places of a
// coarser map. goniochrome-surfaces(7), "Minification".
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "brdf/lobe_surface.h"
#include "brdf/sbrdf.h"
#include "render/gbuffer.h"
#include "render/textures/sbrdf_kernel.h"

namespace goniochrome::render {

// A coarser map: each texel is the mean of those that it covers, with as many lobes as that takes up to
// kMostLevelLobes, or up to those of the finest map if these are more. Its normal is their mean, and its lobes are as
// much wider as these normals vary.
constexpr int kMostLevelLobes = 8;
struct TextureLevel {
  int width = 0, height = 0;
  std::vector<brdf::LobeSurface> texels;        // row by row from the top
  std::vector<float> alpha = {}, normals = {};  // as SbrdfTexture has them
};
// Half as many texels along each side at each step, down to one texel; none of a texture of one texel. They have those
// lobes of the texture whose bits are set.
std::vector<TextureLevel> texture_levels(const brdf::SbrdfTexture& texture, std::uint32_t lobes = ~0U);

// The place and the footprint of a texture that is laid `repeat` times.
TexturePlace repeated(const TexturePlace& place, double repeat);

// The places at which the part of a pixel is shaded that a sample stands for: a grid over its footprint, on the finest
// level where kMostProbes of them lie no farther apart than texels. On the texture itself there are up to five more
// along each side than texels, as long as kMostProbes are enough for that: between texels the colors are blended, and
// in the middle of each texel the blend has an edge, which a grid as coarse as the texels misses. A footprint without
// such an edge has one probe.
constexpr int kMostProbes = 128;
struct FilterProbes {
  int level = 0, across = 1, down = 1;  // level 0 is the texture itself
  double wide = 1, high = 1;            // of the grid, relative to the footprint
  int count() const { return across * down; }
};
// Footprints are `scale` times those of `place`, along each side; the texture has so many texels and levels beside
// itself.
FilterProbes filter_probes(const TexturePlace& place, double scale, int width, int height, int levels);
// The probe of this number.
TexturePlace probe_place(const TexturePlace& place, double scale, const FilterProbes& probes, int number);
// True if a footprint lies between the middles of texels that are neighbors, where it has no edge. Its mean is then the
// value in its middle, but for the small part of the blend that is bilinear.
bool is_between_texels(const TexturePlace& place, double scale, int width, int height);

// The texels that the probes of a footprint show, each once, with the part that it has of the whole. All probes of a
// pixel have one normal and one viewer, so that each texel is shaded once, however many probes show it.
class SeenTexels {
 public:
  // The texture or its level has so many texels. The result is valid until the next call.
  std::span<TexelShare> of(const TexturePlace& place, double scale, const FilterProbes& probes, int width, int height);

 private:
  std::vector<TexelShare> seen_;      // in the order in which the probes meet them
  std::vector<std::uint16_t> slots_;  // number in seen_ + 1, by the place in a window around the footprint; 0: none
};

}  // namespace goniochrome::render
