// A spatially varying surface is a texture here: each texel has a sum of generalized cosine lobes and the direction to
// which its frame is turned. goniochrome-surfaces(7), "SPATIALLY VARYING SURFACES"; [McAllister2002]
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "brdf/lafortune.h"

namespace goniochrome::brdf {

// Texels row by row from the top, each: diffuse RGB; cos and sin of twice the angle from the tangent to the texel's own
// x axis (turned by 180 deg a lobe is the same); then for each lobe albedo RGB, axes XYZ, exponent. The diffuse part
// and the albedos of a texel that covers only a part of what lies beneath it are multiplied by its alpha.
struct SbrdfTexture {
  int width = 0, height = 0, lobes = 0;
  std::vector<float> values;
  std::vector<float> alpha = {};  // of each texel, the part that it covers, 0 to 1; empty where that is all
  // For each lobe of each texel, cos and sin of twice the angle from the tangent to an x axis of its own, which then
  // takes the place of the texel's; empty where the texel's serves all of its lobes.
  std::vector<float> turns = {};
  // The unit normal of each texel's frame along tangent, bitangent and the normal of the surface; empty where the
  // surface is flat.
  std::vector<float> normals = {};

  int stride() const { return 5 + 7 * lobes; }
  const float* texel(int column, int row) const {
    return &values[(static_cast<std::size_t>(row) * width + column) * static_cast<std::size_t>(stride())];
  }
  Vec3 normal(std::size_t texel) const {
    if (normals.empty()) return {0, 0, 1};
    return vec3(&normals[3 * texel]);
  }
  // Cos and sin of twice the angle of the x axis of a lobe.
  const float* frame(int column, int row, int lobe) const {
    if (turns.empty()) return texel(column, row) + 3;
    return &turns[2 * ((static_cast<std::size_t>(row) * width + column) * static_cast<std::size_t>(lobes) + lobe)];
  }
};

// The exponents of all lobes of textures that reflect anything. Without such lobes `low` is infinite and `high` is 0.
struct LobeRange {
  double low = HUGE_VAL, high = 0;
  void add(const SbrdfTexture& texture);
};

// The x axis whose cosine and sine of twice the angle these are: tangent * t + bitangent * b.
struct SbrdfAxis {
  double tangent = 1, bitangent = 0;
};
SbrdfAxis sbrdf_axis(const float* cos_sin_twice);

// One texel, ready to be shaded: its x axis is x_tangent * tangent + x_bitangent * bitangent.
struct SbrdfTexel {
  Lafortune surface;
  double x_tangent = 1, x_bitangent = 0;
};
// The whole texel in its own frame, whatever frames its lobes have.
SbrdfTexel sbrdf_texel(const SbrdfTexture& texture, int column, int row);
// The texel as a sum of surfaces that have one frame each. All have as many lobes as the texture, of which those of
// other frames reflect nothing; the first has the diffuse part.
std::vector<SbrdfTexel> sbrdf_texels(const SbrdfTexture& texture, int column, int row);

// The axes of a texel in the world, on a surface with unit normal. The tangent is made perpendicular; if
// it lies along the normal, any direction in the surface takes its place.
struct SurfaceFrame {
  Vec3 x, y, z;
  Vec3 local(const Vec3& d) const { return {dot(d, x), dot(d, y), dot(d, z)}; }
  Vec3 world(const Vec3& d) const { return d.x * x + d.y * y + d.z * z; }
};
SurfaceFrame surface_frame(const SbrdfTexel& texel, const Vec3& normal, const Vec3& tangent);

// The normal of a texel in the world, from the one in the frame of tangent, bitangent and unit normal. One that looks
// away from the viewer, a unit direction, becomes the nearest that does not.
Vec3 texel_normal(const Vec3& own, const Vec3& normal, const Vec3& tangent, const Vec3& to_viewer);

// The four texels around a place and their bilinear weights; u runs right, v up, both repeat beyond 0..1. The texels
// are to be shaded one by one and the colors blended: a mean of two lobes' parameters is a third lobe.
struct TextureTap {
  int column = 0, row = 0;
  double weight = 0;
};
std::array<TextureTap, 4> texture_taps(int width, int height, double u, double v);

// The texels of a row of `from` that a texel of a row of `to` covers, or between which it lies, and their shares.
std::vector<std::pair<int, double>> covered_texels(int at, int to, int from);

// One texel in the place of all: the mean diffuse part, and for each lobe, weighted by albedo/(n+1), the mean of that,
// of log(n+1) and of the axes as matrices of the tangent frame, whose common direction is its frame's; where lobes have
// frames of their own, each keeps its own direction. It is the control that shows what a texture gains; it is not the
// mean of the texels' BRDFs, which would take as many lobes as there are texels. Alpha is the mean, and so is the
// normal, whose variance widens the lobes.
SbrdfTexture mean_texture(const SbrdfTexture& texture);

}  // namespace goniochrome::brdf
