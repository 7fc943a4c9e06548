// Light from all around is handed to a gatherer in patches: pieces of texels, or whole blocks of them. A gatherer has a
// Grain, and `add(patch, light)`; see gatherer.h. goniochrome-plan(7), "REFERENCE INTEGRATOR".
#pragma once

#include <algorithm>
#include <array>

#include "envmap/block_tree.h"
#include "envmap/environment.h"
#include "render/integral/gatherer.h"

namespace goniochrome::render {

// The piece (i, j) of a texel cut into k x k.
inline Patch piece(const envmap::Environment& env, int column, int row, int i, int j, int k) {
  const double step = 1.0 / k, left = column + i * step, top = row + j * step;
  return {env.direction_at(left + 0.5 * step, top + 0.5 * step), env.solid_angle(left, top, left + step, top + step)};
}

template <class AnyGatherer>
void gather_texel(const envmap::Environment& env, int column, int row, const Patch& whole, const color::Rgb& radiance,
                  AnyGatherer& point) {
  const int k = point.grain().pieces(whole.direction);
  if (k == 1) return point.add(whole, radiance);
  for (int j = 0; j < k; ++j)
    for (int i = 0; i < k; ++i) point.add(piece(env, column, row, i, j, k), radiance);
}

// The variance along one axis of even light that fills the cap of a block.
inline double even_variance(const envmap::BlockTree::Block& block) {
  return 0.25 * block.sine * block.sine;
}

// The mean direction of a block's light, all channels together, its variance along each axis about it, and how far the
// channels are from it.
struct Beam {
  Vec3 direction;
  double variance;
  std::array<Vec3, 3> of_channels;
};
inline Beam beam_of(const envmap::BlockTree::Block& block) {
  Vec3 moment;
  double flux = 0;
  for (int c = 0; c < 3; ++c) {
    moment += vec3(block.moment[c]);
    flux += block.flux[c];
  }
  const double size = length(moment);
  // Floats hold the moments to some 1e-6: narrower blocks are taken as even.
  constexpr double kRounded = 1e-5;
  const double variance = 1 - size / flux, even = even_variance(block);
  const Vec3 direction = (1 / size) * moment;
  Beam beam{direction, variance < kRounded ? std::min(even, kRounded) : variance, {}};
  for (std::size_t c = 0; c < 3; ++c) {
    if (!(block.flux[c] > 0)) continue;
    const Vec3 own = (1 / block.flux[c]) * vec3(block.moment[c]);
    beam.of_channels[c] = own - dot(own, direction) * direction;
  }
  return beam;
}

template <class AnyGatherer>
void gather_blocks(const envmap::BlockTree& tree, AnyGatherer& point) {
  const envmap::Environment& env = tree.environment();
  tree.walk(
      [&](const envmap::BlockTree::Block& block) {
        const color::Rgb flux = vec3(block.flux);
        if (flux == color::Rgb{}) return false;
        if (point.ends_at_horizon()) {
          const double above = dot(point.normal(), vec3(block.axis));
          if (block.cosine > 0 && above < -block.sine) return false;
          if (above < block.sine && point.grain().opens_at_horizon(block)) return true;
        }
        const Beam beam = beam_of(block);
        // A strip's variance lies along one axis: the cap's own bounds it.
        if (point.grain().opens(block, std::max(beam.variance, even_variance(block)))) return true;
        point.add({beam.direction, 1, beam.variance, &beam.of_channels}, flux);
        return false;
      },
      [&](int column, int row) {
        const color::Rgb radiance = env.texel(column, row);
        if (radiance == color::Rgb{}) return;
        gather_texel(env, column, row, {env.direction(column, row), env.solid_angle(column, row)}, radiance, point);
      });
}

}  // namespace goniochrome::render
