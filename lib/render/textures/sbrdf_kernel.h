// The kernel that shades textures of lobes. It is compiled for several instruction sets, of which the best that the
// processor has is chosen at run time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "render/cpu/cpu_kernel.h"

namespace goniochrome::render {

// A texture is packed as colors and shapes. The colors of a texel are 4 floats for its diffuse part, RGB and alpha, and
// 4 for each lobe: RGB 0, relative to the largest albedo that this lobe has in texels of the same shape. A shape is 12
// floats for each lobe: axes X Y Z and exponent n; the logarithms of that albedo, times 2 pi/(n+1) and as it is; the
// map of the exponent at or below n and the share of the next; the row of the horizon table likewise; the cosine and
// sine of the angle from the tangent to the x axis of its own.
constexpr std::size_t kTexelAlpha = 3, kShapeFloats = 12;
constexpr std::size_t kLobeAxes = 0, kLobeExponent = 3, kLobeEnergy = 4, kLobeAlbedo = 5, kLobeMap = 6,
                      kLobeHorizon = 8, kLobeTurn = 10;
constexpr float kNoLobe = -1e4F;  // the logarithm of an albedo of 0

struct SbrdfShading {
  SingleMap diffuse;                // P_1; null where there is no environment
  const SingleMap* maps = nullptr;  // P_n, ascending exponents
  // Rows of so many segments, and one pair more: the mean cosine above the surface over a lobe whose middle m is at the
  // cosine (i/segments)^2, and s, where m + s n is the mean direction of the light that it gathers there. Null: the
  // cosine of the middle itself, and 0.
  const float* horizon = nullptr;
  int horizon_segments = 0;
  const float* colors = nullptr;  // of the texels
  int lobes = 0;                  // of a texel
  std::uint32_t lobes_on = ~0U;   // by bits
  int lights = 0;
  const float* light = nullptr;        // 8 a light: direction, variance of its disc; pi times its white, 0
  const PlacedLamp* placed = nullptr;  // of each light; null: all are far away
  const float* product = nullptr;      // product_columns()
};

// A texel and the part that it has of what a pixel shows.
struct TexelShare {
  std::uint32_t texel = 0;  // row by row
  float share = 0;
};

// Points as separate arrays. The first `count` of them are shaded; the others must hold any finite numbers and shapes,
// since the kernel computes with them as well. Each shows texels of one shape, whose lobes are shaded as one, and the
// diffuse parts of others or the same.
struct SbrdfPoints {
  float nx[kPointsAtOnce], ny[kPointsAtOnce], nz[kPointsAtOnce];
  float vx[kPointsAtOnce], vy[kPointsAtOnce], vz[kPointsAtOnce];  // toward the viewer, of any length
  float tx[kPointsAtOnce], ty[kPointsAtOnce], tz[kPointsAtOnce];  // tangent, of any length and not yet level
  float px[kPointsAtOnce], py[kPointsAtOnce], pz[kPointsAtOnce];  // from origin_of() the mesh, for lamps at a place
  const float* shape[kPointsAtOnce];
  std::span<const TexelShare> lobed[kPointsAtOnce], diffuse[kPointsAtOnce];
};

// rgba: 4 floats a point, of which the fourth has no meaning; 0 for a point that is seen from below.
void shade_texels(const SbrdfShading& shading, const SbrdfPoints& points, int count, float* rgba);

}  // namespace goniochrome::render
