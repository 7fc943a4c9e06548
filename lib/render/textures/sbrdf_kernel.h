// The kernel that shades textures of lobes. It is compiled for several instruction sets, of which the best that the
// processor has is chosen at run time.
#pragma once

#include <cstddef>
#include <cstdint>

#include "render/cpu/cpu_kernel.h"

namespace goniochrome::render {

// A packed texel: 8 floats (diffuse RGB and alpha; the cosine and sine of the angle from the tangent to its x axis; its
// shape, and 0), then 16 for each lobe: its color RGB 0, relative to the largest albedo that this lobe has in texels of
// the same shape; axes X Y Z and exponent n; the logarithms of that albedo, times 2 pi/(n+1) and as it is; the map of
// the exponent at or below n and the share of the next; the row of the horizon table likewise; the cosine and sine of
// the angle from the tangent to the x axis of its own.
constexpr std::size_t kTexelFloats = 8, kTexelLobeFloats = 16;
constexpr std::size_t kTexelAlpha = 3, kTexelShape = 6;
constexpr std::size_t kLobeAxes = 4, kLobeExponent = 7, kLobeEnergy = 8, kLobeAlbedo = 9, kLobeMap = 10,
                      kLobeHorizon = 12, kLobeTurn = 14;
constexpr float kNoLobe = -1e4F;  // the logarithm of an albedo of 0
// Texels of one shape have the same lobes in other colors, so that those around a place are shaded as one. The shape
// kOwnShape is that of no other texel.
constexpr float kOwnShape = 0;

// P_n on a cube, faces with a border of one texel, R G B 0 a texel.
struct LobeMap {
  int size = 0;
  const float* texels = nullptr;
};

struct SbrdfShading {
  LobeMap diffuse;                // P_1; null where there is no environment
  const LobeMap* maps = nullptr;  // ascending exponents
  // Rows of so many segments, and one pair more: the mean cosine above the surface over a lobe whose middle m is at the
  // cosine (i/segments)^2, and s, where m + s n is the mean direction of the light that it gathers there. Null: the
  // cosine of the middle itself, and 0.
  const float* horizon = nullptr;
  int horizon_segments = 0;
  int lobes = 0;                 // of a packed texel
  std::uint32_t lobes_on = ~0U;  // by bits
  int lights = 0;
  const float* light = nullptr;        // 8 a light: direction, variance of its disc; pi times its white, 0
  const PlacedLamp* placed = nullptr;  // of each light; null: all are far away
  const float* reflection = nullptr;   // k[c][d][e]; null: the component-wise product
};

constexpr std::size_t kTexelsAtOnce = 4;

// Points as separate arrays. The first `count` of them are shaded; the others must hold any finite numbers and texels,
// since the kernel computes with them as well. Each shows `taps` texels, and those of one shape are a group.
struct SbrdfPoints {
  float nx[kPointsAtOnce], ny[kPointsAtOnce], nz[kPointsAtOnce];
  float vx[kPointsAtOnce], vy[kPointsAtOnce], vz[kPointsAtOnce];  // toward the viewer, of any length
  float tx[kPointsAtOnce], ty[kPointsAtOnce], tz[kPointsAtOnce];  // tangent, of any length and not yet level
  float px[kPointsAtOnce], py[kPointsAtOnce], pz[kPointsAtOnce];  // from origin_of() the mesh, for lamps at a place
  int taps = 0;
  const float* texel[kTexelsAtOnce][kPointsAtOnce];
  float share[kTexelsAtOnce][kPointsAtOnce];
  std::uint8_t group[kTexelsAtOnce]
                    [kPointsAtOnce];  // the texels of each group by bits, the first groups first; 0: none
  int groups = 0;                     // the most that a point has
};

// rgba: 4 floats a point, of which the fourth has no meaning; 0 for a point that is seen from below.
void shade_texels(const SbrdfShading& shading, const SbrdfPoints& points, int count, float* rgba);

}  // namespace goniochrome::render
