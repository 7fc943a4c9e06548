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

// A directional light. `white` is the radiance that a perfect white diffuser facing it shows: irradiance / pi.
struct Light {
  Vec3 direction{0, 1, 0};  // to the light, unit
  color::Rgb white{1, 1, 1};
};

enum class Background { kNone, kColor, kEnvironment };

class SurfaceLayer;

struct Scene {
  const mesh::Mesh* mesh = nullptr;
  std::vector<paint::LobeFit> paints;                   // one for each part of the mesh, in order
  const envmap::PrefilteredEnvironment* env = nullptr;  // none: lights alone
  std::vector<Light> lights;
  Background background = Background::kNone;
  color::Rgb background_color;
  std::vector<double> gloss_deg = {};  // for each part, the angle of incidence its gloss weights hold at; none: 45
  std::vector<paint::Anisotropy> anisotropy = {};  // for each part; alpha 0 is none. The tangent runs level around +Y
  color::ReflectionOperator reflection = color::component_wise();
  const SurfaceLayer* layer = nullptr;        // textures and color maps of parts, if there are any
  const envmap::BlockTree* texels = nullptr;  // of the image that env was made from, for engines that sum it
};

// The exponents (finite, ascending) of the lobes with any weight, over all paints.
std::vector<double> lobe_exponents(const std::vector<paint::LobeFit>& paints);

// Whether any paint has a mirror lobe.
bool has_mirror(const std::vector<paint::LobeFit>& paints);

// A paint's lobe of this exponent, or null where it has none.
const paint::Lobe* find_lobe(const paint::LobeFit& paint, double exponent);

// The brightest that a perfect white diffuser can be in this light: what the eye takes for white. Its direction is
// where the environment's irradiance is largest; lights add what they give to a surface that faces them.
struct DiffuseWhite {
  double luminance = 0;
  Vec3 direction{0, 1, 0};  // of the environment's largest irradiance
};
DiffuseWhite diffuse_white(const envmap::PrefilteredEnvironment* env, const std::vector<Light>& lights);

}  // namespace goniochrome::render
