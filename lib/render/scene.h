// A scene is what a picture shows: a mesh, a paint for each of its parts, the light, and the background.
#pragma once

#include <optional>
#include <vector>

#include "base/result.h"
#include "color/reflection.h"
#include "envmap/block_tree.h"
#include "envmap/prefiltered.h"
#include "mesh/mesh.h"
#include "paint/paint.h"

namespace goniochrome::render {

// A lamp far away, or at a place. It is a disc of even radiance, or a point. goniochrome-rendering(7), "LAMPS".
struct Light {
  // A lamp that is a sphere at a place: its irradiance falls with the square of the distance.
  struct Place {
    Vec3 position;        // of its middle, in units of the mesh
    double distance = 1;  // at which it has the white and the radius below
  };
  Vec3 direction{0, 1, 0};    // to its middle, unit; of a lamp at a place, as seen from the middle of the mesh
  color::Rgb white{1, 1, 1};  // the radiance of a perfect white diffuser that faces it: irradiance / pi
  double radius_rad = 0;  // of the disc as it is seen, 0..kWidestDisc_rad; 0: a point, whose mirror image is not drawn
  std::optional<Place> place = {};
  bool mirrored = true;  // whether a mirror shows it; else its image is that of the environment it is a part of

  // The radiance of the disc, which a mirror shows within it. Black for a point.
  color::Rgb radiance() const;
  // True if this direction (unit) meets the disc.
  bool meets(const Vec3& toward) const;
};

// The lamp as it is seen from a point of the mesh: without a place. Within the lamp it fills half of the sphere. A
// point lamp has no surface that a point of the mesh could touch: nearer than this part of its distance it grows no
// brighter.
constexpr double kNearestPoint = 1e-6;
Light light_at(const Light& light, const Vec3& position);

// A bright spot of an environment as a lamp. Mirrors do not show it, because they show the environment itself.
inline Light light_of(const envmap::Spot& spot) {
  return {spot.direction, spot.white, spot.radius_rad, {}, false};
}

// Directions to parts of a disc that are alike and small enough to be a point each, for what changes slowly: the middle
// of a narrow disc alone. The weights are solid angles relative to pi sin^2(radius).
struct DiscDirection {
  Vec3 direction;
  double weight = 1;
};
std::vector<DiscDirection> disc_directions(const Light& light);
// A direction to a disc, even over its solid angle, by numbers in [0,1).
Vec3 disc_direction(const Light& light, double u, double v);

enum class Background { kNone, kColor, kEnvironment };

class SurfaceLayer;
struct SceneSpectra;

// A level floor that reaches to the horizon.
struct Ground {
  // kShadow: the lower half of the environment, projected onto the floor as a probe saw it that stood on it, and
  // darkened where the mesh takes light from it. kPaint: a floor that wears a paint.
  enum class Kind { kShadow, kPaint };
  Kind kind = Kind::kShadow;
  double height = 0;           // of the plane y = height, in units of the mesh
  paint::LobeFit paint = {};   // with kPaint
  Vec3 probe_eye = {0, 1, 0};  // with kShadow: where the environment was seen from, above the floor
};
// The ground of an environment at this height, by default that of the lowest vertex. The environment was seen from this
// height above it, over the middle of the mesh; an eye height of 0 stands for a third of the mesh's longest side.
Ground ground_below(const mesh::Mesh& mesh, const std::optional<double>& height = {}, double eye_height = 0);

struct Scene {
  const mesh::Mesh* mesh = nullptr;
  std::vector<paint::LobeFit> paints;                   // one for each part of the mesh, in order
  const envmap::PrefilteredEnvironment* env = nullptr;  // none: lights alone
  std::vector<Light> lights;
  Background background = Background::kNone;
  color::Rgb background_color;
  std::vector<double> gloss_deg = {};  // for each part, the angle of incidence its gloss weights hold at; none: 45
  std::vector<paint::Anisotropy> anisotropy = {};  // for each part; alpha 0 is none. The tangent runs level around +Y
  // Brushed parts are drawn about as many tilted normals as this error asks for, relative to the peak of the lobe, but
  // about no more than `most_tilts`.
  double tilt_error = 0.005;
  int most_tilts = 1024;
  color::ReflectionOperator reflection = color::component_wise();
  const SurfaceLayer* layer = nullptr;        // textures and color maps of parts, if there are any
  const envmap::BlockTree* texels = nullptr;  // of the image that env was made from, for engines that sum it
  std::vector<color::Rgb> emission = {};      // radiance of each part that shines by itself; none where there are fewer
  std::optional<Ground> ground = {};
  // The spectra of all paints and lamps, for engines that follow light in bands of wavelength (SceneSpectra, in
  // spectra.h). None: light and paint have three channels.
  const SceneSpectra* spectra = nullptr;
  // Flags of the parts that are panes of clear glass that is seen through, and wear pane_finish(); none where there are
  // fewer. Light passes panes on its way to other surfaces as if they were not there. See panes.h.
  std::vector<bool> panes = {};
  // The flakes of each part's paint; none where there are fewer. They are seen one by one with the effect sparkle.
  std::vector<std::optional<paint::KnownFlakes>> flakes = {};
};

// True if the scene has parts that only engines that trace rays can draw: a floor, or parts that shine by themselves.
bool needs_rays(const Scene& scene);

// True if any lamp stands at a place, so that its direction and its light are others at each point of the mesh.
bool has_placed_lamps(const Scene& scene);

// The exponents (finite, ascending) of the lobes with any weight, over all paints.
std::vector<double> lobe_exponents(const std::vector<paint::LobeFit>& paints);

// True if any paint has a mirror lobe.
bool has_mirror(const std::vector<paint::LobeFit>& paints);

// True if the lobe of this exponent, which may be the mirror's, has such a weight in the paint's own lobes or in those
// of one of its views: an exponent may stand in a view alone.
enum class LobeWeight { kDirectionalDiffuse, kGloss };
bool wears_lobe(const paint::LobeFit& paint, double exponent, LobeWeight weight);

// A paint's lobe of this exponent, or null where it has none.
const paint::Lobe* find_lobe(const paint::LobeFit& paint, double exponent);

// The brightest that a perfect white diffuser can be in this light: what the eye takes for white. Its direction is
// where the environment's irradiance is largest; lights add what they give to a surface that faces them.
struct DiffuseWhite {
  double luminance = 0;
  Vec3 direction{0, 1, 0};  // of the environment's largest irradiance
};
DiffuseWhite diffuse_white(const envmap::PrefilteredEnvironment* env, const std::vector<Light>& lights);

// The luminance of a perfect white diffuser that faces a direction (unit), with nothing in the way of the light.
double facing_white(const envmap::PrefilteredEnvironment* env, const std::vector<Light>& lights, const Vec3& direction);

// The luminance that automatic exposure brings to 1, and .18 of it to middle gray: the mean of the white diffuser that
// lies level and of the one that faces the camera, `to_camera` from what it looks at. Where both are dark, that of
// diffuse_white(). What a picture shows of a body lies between the two. 0 without light.
double metered_white(const envmap::PrefilteredEnvironment* env, const std::vector<Light>& lights,
                     const Vec3& to_camera);

}  // namespace goniochrome::render
