// The reference integrator is the yardstick of every picture: it sums the exact BRDF times the environment in its full
// resolution, in double precision and without prefiltering. goniochrome-plan(7), "REFERENCE INTEGRATOR".
#pragma once

#include <vector>

#include "envmap/block_tree.h"
#include "envmap/environment.h"
#include "render/effects.h"
#include "render/gbuffer.h"
#include "render/integral/exact_model.h"
#include "render/scene.h"

namespace goniochrome::render {

// The light from all around, and how finely it is summed.
struct Surroundings {
  // Texel by texel: the yardstick. `env` may be null: none.
  Surroundings(const envmap::Environment* env) : texels(env) {}  // NOLINT(google-explicit-constructor)
  // By blocks of texels, each as one beam from its mean direction where the standard deviation of its directions is at
  // most `spread` of that of every lobe that reaches it (1/sqrt E), and narrower than `spread` (radians) on the
  // horizon.
  Surroundings(const envmap::BlockTree& tree, double spread)
      : texels(&tree.environment()), blocks(&tree), most_spread(spread) {}

  const envmap::Environment* texels;
  const envmap::BlockTree* blocks = nullptr;
  double most_spread = 0;
};

// The radiance of each point, in the working space: the integral of f L cos_i over the texels above the horizon, each a
// constant patch with its exact solid angle, cut finer where a lobe is narrower than a texel; the mirror lobe's Fresnel
// times the texel that it sees; and the lights. Bit-identical for any number of threads.
std::vector<color::Rgb> reference_radiance(const std::vector<SurfacePoint>& points, const Surroundings& around,
                                           const std::vector<Light>& lights);

// The integral for textures: of the blended texels' f L cos_i. `reflection` null: component-wise.
std::vector<color::Rgb> textured_radiance(const std::vector<TexturedPoint>& points, const Surroundings& around,
                                          const std::vector<Light>& lights,
                                          const color::ReflectionOperator* reflection);

// The integral for points of a scene, by the effects that are on. About the tilted normals of an anisotropic lobe: many
// where texels are summed, those of the effects where blocks are.
std::vector<color::Rgb> exact_radiance(const std::vector<VisiblePoint>& points, const Scene& scene,
                                       const Effects& effects, const Surroundings& around);

}  // namespace goniochrome::render
