// Sums of generalized cosine lobes whose frames may differ: a texel, a paint as a texture holds it, or a mixture of
// such surfaces. goniochrome-surfaces(7), "Mixtures".
#pragma once

#include <cstdint>
#include <vector>

#include "base/vec3.h"
#include "brdf/lafortune.h"
#include "brdf/sbrdf.h"
#include "paint/paint.h"

namespace goniochrome::brdf {

// A lobe whose x axis is turned by `turn_rad` from the tangent toward the bitangent, -pi/4 to pi/4. A lobe that is the
// same along x and y has the turn 0.
struct TurnedLobe {
  LafortuneLobe lobe;
  double turn_rad = 0;
};

struct LobeSurface {
  color::Rgb diffuse;  // 1/sr
  std::vector<TurnedLobe> lobes;
};

// The lobe with its axes in a frame that is turned by any angle: a quarter of a turn exchanges x and y.
TurnedLobe turned_lobe(const LafortuneLobe& lobe, double turn_rad);

// f(wi,wo) in 1/sr, both directions in the frame of tangent, bitangent and normal; 0 where one is below the surface.
color::Rgb brdf(const LobeSurface& surface, const Vec3& to_light, const Vec3& to_viewer);

// The light that a lobe about its own middle reflects where |p| is 1: 2 pi/(n+1) times the mean albedo.
double lobe_energy(const LafortuneLobe& lobe);

// One texel, without its lobes of albedo 0 and those whose bits are not set.
LobeSurface lobe_surface(const SbrdfTexture& texture, int column, int row, std::uint32_t lobes = ~0U);

// Adds `share` times the reflectance of `part` to `sum`. A lobe that has the shape of one that is there adds to its
// albedo, so that mixtures of paints on one basis have no more lobes than the basis. The sum is exact.
void add_surface(LobeSurface& sum, const LobeSurface& part, double share);

// True if one frame serves all lobes, as a texel needs it.
bool has_one_frame(const LobeSurface& surface);

// Writes the surface to the values of a texel with so many lobes, ascending in exponent; lobes that are not needed get
// the albedo 0 and the exponent `unused`. The surface must have no more lobes than that, and one frame where `turns` is
// null; else these get the frame of each lobe, as SbrdfTexture has them.
void write_texel(const LobeSurface& surface, int lobes, double unused_exponent, float* values, float* turns = nullptr);

// How a paint becomes lobes of a texel.
struct PaintedSurface {
  LobeSurface surface;
  double mirror_error = 0;  // mean relative error of the strength of mirror and gloss over viewing angles up to 80 deg
};

// A fitted paint as lobes about the mirror direction that have the exponents of its own lobes; its mirror becomes lobes
// of the exponent `mirror_exponent`. The coat lets through what it does at 45 deg, which half of a sphere exceeds, and
// of the light of the diffuse part its mean over the hemisphere. Gloss and mirror grow toward grazing angles as the
// coat reflects: by lobes whose axes x and y are longer than z, at most two for each exponent. Weights by view, tilted
// lobes and anisotropy are not kept.
PaintedSurface painted_surface(const paint::LobeFit& fit, double gloss_deg, double mirror_exponent);

// The lobe of a smooth coat of that index: the part of `painted_surface` that is its mirror.
PaintedSurface coat_surface(double coat_index, double share, double mirror_exponent);

}  // namespace goniochrome::brdf
