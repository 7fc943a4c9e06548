// Minification of textures: a pixel that covers many texels shows their mean, which is shaded at some places of a
// coarser map. goniochrome-theory(7), SPATIALLY VARYING SURFACES, Minification.
#pragma once

#include <cstdint>
#include <vector>

#include "brdf/lobe_surface.h"
#include "brdf/sbrdf.h"
#include "render/gbuffer.h"

namespace goniochrome::render {

// A coarser map: each texel is the mean of those that it covers, with as many lobes as that takes up to
// kMostLevelLobes, or up to those of the finest map if these are more.
constexpr int kMostLevelLobes = 8;
struct TextureLevel {
  int width = 0, height = 0;
  std::vector<brdf::LobeSurface> texels;  // row by row from the top
  std::vector<float> alpha = {};          // as SbrdfTexture has it
};
// Half as many texels along each side at each step, down to one texel; none of a texture of one texel. They have those
// lobes of the texture whose bits are set.
std::vector<TextureLevel> texture_levels(const brdf::SbrdfTexture& texture, std::uint32_t lobes = ~0U);

// The place and the footprint of a texture that is laid `repeat` times.
TexturePlace repeated(const TexturePlace& place, double repeat);

// The places at which the part of a pixel is shaded that a sample stands for: a grid over its footprint, on the finest
// level where kMostProbes of them lie no farther apart than texels.
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

}  // namespace goniochrome::render
