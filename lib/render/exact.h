// The reference integrator is the yardstick of every picture: it sums the exact BRDF times the environment in its full
// resolution, in double precision and without prefiltering. goniochrome-theory(7), REFERENCE INTEGRATOR.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "brdf/coat_facets.h"
#include "envmap/block_tree.h"
#include "envmap/environment.h"
#include "image/image.h"
#include "render/gbuffer.h"
#include "render/renderer.h"
#include "render/scene.h"
#include "render/surface_layer.h"

namespace goniochrome::render {

// How the BRDF of a point is evaluated beyond the weights of its paint.
struct ExactModel {
  bool fresnel = false;  // of gloss lobes, relative to gloss_deg, and of the mirror
  double gloss_deg = 45;
  bool horizon = true;  // each direction with its own cosine, and none from below; else as prefiltered maps have it
  std::vector<brdf::Tilt> tilts;                          // none: isotropic
  std::optional<brdf::CoatFacets> coat;                   // beside the gloss of the paint
  const color::ReflectionOperator* reflection = nullptr;  // null: component-wise
  // In the place of K_D and K_DD: in image light, under lights, or in both.
  const brdf::ColorMap* map = nullptr;
  brdf::CriticalAngle treatment = brdf::CriticalAngle::kSlide;
  bool map_in_image = false, map_under_lights = false;
};

struct SurfacePoint {
  Vec3 normal, to_viewer;  // unit, on the same side
  const paint::LobeFit* paint = nullptr;
  const ExactModel* model = nullptr;  // null: that of a bare lobe model, the mirror with its Fresnel reflectance
  Vec3 position = {};                 // for lamps at a place
};

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

// A point of a texture.
struct TexturedPoint {
  Vec3 normal, to_viewer;
  SurfaceLayer::Place place;
  Vec3 position = {};
};

// The same for textures: the integral of the blended texels' f L cos_i. `reflection` null: component-wise.
std::vector<color::Rgb> textured_radiance(const std::vector<TexturedPoint>& points, const Surroundings& around,
                                          const std::vector<Light>& lights,
                                          const color::ReflectionOperator* reflection);

// The same for points of a scene, by the effects that are on. About the tilted normals of an anisotropic lobe: many
// where texels are summed, those of the effects where blocks are.
std::vector<color::Rgb> exact_radiance(const std::vector<VisiblePoint>& points, const Scene& scene,
                                       const Effects& effects, const Surroundings& around);

// How far a picture is from the reference.
struct PictureError {
  int checked_pixels = 0;
  double de00_mean = 0, de00_p95 = 0, de00_max = 0;
  int worst_x = 0, worst_y = 0;
  double time_s = 0;
};

// Random visible pixels that show no panes, `count` of them or all where there are fewer: their places in the picture
// and their points.
struct PixelSample {
  std::vector<std::array<int, 2>> places;
  std::vector<VisiblePoint> points;
};
PixelSample sampled_pixels(const Gbuffer& gbuffer, const Scene& scene, int count, std::uint64_t seed);

// Compares the centers of `count` random visible pixels (all, where there are fewer) with the reference, as CIEDE2000
// of Lab values relative to `white_luminance`, D65. The frame must hold its centers. The reference has everything that
// the scene calls for.
PictureError picture_error(const Frame& frame, const Scene& scene, const Surroundings& around, double white_luminance,
                           int count, std::uint64_t seed);

}  // namespace goniochrome::render
